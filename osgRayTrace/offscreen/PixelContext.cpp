// PixelContext.cpp - the common part of OSMesa and EGL contexts. Layer: offscreen.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/offscreen/PixelContext.h"

#include <osg/GL>
#include <osg/Notify>
#include <osg/State>

namespace osgRayTrace::engine
{

namespace
{

/// Holds the calling thread's current context, which is only compared, never followed: it may be
/// gone.
struct CurrentContext
{
    const PixelContext* context = nullptr;
    void (*unbind)() = nullptr;
};

thread_local CurrentContext t_current;

osg::GraphicsContext::Traits* makeTraits(int width, int height, osg::GraphicsContext* sharedContext)
{
    auto* traits = new osg::GraphicsContext::Traits;
    traits->x = 0;
    traits->y = 0;
    traits->width = width;
    traits->height = height;
    traits->red = traits->green = traits->blue = traits->alpha = 8;
    traits->depth = 24;
    traits->stencil = 8;
    traits->pbuffer = true;
    traits->doubleBuffer = false;
    traits->windowDecoration = false;
    traits->sharedContext = sharedContext;
    return traits;
}

} // namespace

PixelContext::PixelContext(int width, int height, osg::GraphicsContext* sharedContext)
{
    _traits = makeTraits(width, height, sharedContext);

    osg::State* state = new osg::State;
    state->setGraphicsContext(this);
    if (sharedContext)
    {
        state->setContextID(sharedContext->getState()->getContextID());
        incrementContextIDUsageCount(state->getContextID());
    }
    else
    {
        state->setContextID(createNewContextID());
    }
    setState(state);
}

std::string PixelContext::check()
{
    if (!valid()) return "the driver does not give such a context";

    // makeCurrent() would have OSG ask a context for its version that may not answer.
    if (!makeCurrentImplementation()) return "the context cannot be made current";

    const bool answers = glGetString(GL_VERSION) != nullptr;
    GLint maxSize[2] = {0, 0};
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, maxSize);
    releaseContextImplementation();
    if (!answers)
    {
        return "this program's gl* functions belong to another library; see the link order in "
               "<osgRayTrace/offscreen/OffscreenContext>";
    }
    if (_traits->width > maxSize[0] || _traits->height > maxSize[1])
    {
        return "the largest is " + std::to_string(maxSize[0]) + " x " + std::to_string(maxSize[1]);
    }
    return "";
}

bool PixelContext::realizeImplementation()
{
    _realized = valid();
    return _realized;
}

void PixelContext::closeImplementation()
{
    if (t_current.context == this) releaseContextImplementation();
    _realized = false;
    destroyNative();
}

bool PixelContext::makeCurrentImplementation()
{
    if (!valid()) return false;

    // OSMesa and EGL do not know of each other, but their drivers share Mesa's record of the
    // current context: the one must let go before the other takes over.
    if (t_current.unbind && t_current.unbind != unbindFunction()) t_current.unbind();
    t_current = {};

    if (!bindNative()) return false;
    t_current = {this, unbindFunction()};
    return true;
}

bool PixelContext::makeContextCurrentImplementation(osg::GraphicsContext* readContext)
{
    if (readContext == this) return makeCurrentImplementation();
    OSG_WARN << "osgRayTrace: an offscreen context cannot read from another context" << std::endl;
    return false;
}

bool PixelContext::releaseContextImplementation()
{
    if (t_current.context != this) return false;
    t_current.unbind();
    t_current = {};
    return true;
}

void PixelContext::bindPBufferToTextureImplementation(GLenum /*buffer*/)
{
    OSG_WARN << "osgRayTrace: an offscreen context cannot be bound to a texture" << std::endl;
}

void PixelContext::swapBuffersImplementation()
{
    glFinish();
}

osg::ref_ptr<osg::GraphicsContext> checkedContext(const osg::ref_ptr<PixelContext>& context)
{
    const std::string problem = context->check();
    if (problem.empty()) return context;
    const osg::GraphicsContext::Traits& traits = *context->getTraits();
    OSG_WARN << "osgRayTrace: no " << context->className() << " of " << traits.width << " x "
             << traits.height << ": " << problem << std::endl;
    return nullptr;
}

bool isContextSize(const char* function, int width, int height)
{
    if (width > 0 && height > 0) return true;
    OSG_WARN << "osgRayTrace: " << function << ": " << width << " x " << height << " is not a size"
             << std::endl;
    return false;
}

} // namespace osgRayTrace::engine
