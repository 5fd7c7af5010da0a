// PixelContext.h - the common part of OSMesa and EGL contexts. Layer: offscreen.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GraphicsContext>

#include <string>

namespace osgRayTrace::engine
{

/// This is the base of contexts of fixed size whose native part exists from construction on. A
/// subclass creates that part in its constructor, destroys it in closeImplementation() and calls
/// close() in its destructor.
class PixelContext : public osg::GraphicsContext
{
public:
    /// Takes the share of the contextID that an OSG context has, so that close() may give the share
    /// back.
    PixelContext(int width, int height, osg::GraphicsContext* sharedContext);

    /// Returns an empty string if OpenGL answers in this context, else one sentence for the user.
    /// Afterwards no context is current.
    std::string check();

    bool realizeImplementation() override;
    bool isRealizedImplementation() const override { return _realized; }
    void closeImplementation() override;
    bool makeCurrentImplementation() override;
    bool makeContextCurrentImplementation(osg::GraphicsContext* readContext) override;
    bool releaseContextImplementation() override;
    void bindPBufferToTextureImplementation(GLenum buffer) override;

    /// Completes the frame before it returns.
    void swapBuffersImplementation() override;

protected:
    /// A function of this type makes no context of one native kind current on the calling thread.
    using UnbindFunction = void (*)();

    virtual bool bindNative() = 0;
    virtual void destroyNative() = 0;
    virtual UnbindFunction unbindFunction() const = 0;

private:
    bool _realized = false;
};

/// Logs why there is no context, and frees it.
osg::ref_ptr<osg::GraphicsContext> checkedContext(const osg::ref_ptr<PixelContext>& context);

/// Returns false, with a message through osg::notify, unless both sides are 1 or more.
bool isContextSize(const char* function, int width, int height);

} // namespace osgRayTrace::engine
