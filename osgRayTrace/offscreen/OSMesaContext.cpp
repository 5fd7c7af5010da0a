// OSMesaContext.cpp - OpenGL in memory, by OSMesa. Layer: offscreen.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/offscreen/PixelContext.h"
#include <osgRayTrace/offscreen/OffscreenContext>

#include <osg/Notify>

// OSG's header stands before any GL header of OSMesa's, so that OSG's definitions hold.
#include <GL/osmesa.h>

#include <cstddef>
#include <memory>
#include <new>

namespace osgRayTrace
{

namespace
{

class OSMesaPixelContext : public engine::PixelContext
{
public:
    OSMesaPixelContext(int width, int height, OSMesaPixelContext* sharedContext)
        : PixelContext(width, height, sharedContext)
    {
        GLint maxWidth = 0;
        GLint maxHeight = 0;
        OSMesaGetIntegerv(OSMESA_MAX_WIDTH, &maxWidth);
        OSMesaGetIntegerv(OSMESA_MAX_HEIGHT, &maxHeight);
        if (width > maxWidth || height > maxHeight) return;

        const std::size_t sizeBytes = std::size_t(4) * width * height;
        _pixels.reset(new (std::nothrow) unsigned char[sizeBytes]);
        if (!_pixels) return;
        _context = OSMesaCreateContextExt(OSMESA_RGBA, _traits->depth, _traits->stencil, 0,
                                          sharedContext ? sharedContext->_context : nullptr);
    }

    const char* className() const override { return "OSMesaContext"; }
    bool valid() const override { return _context != nullptr; }

protected:
    ~OSMesaPixelContext() override { close(); }

    bool bindNative() override
    {
        return OSMesaMakeCurrent(_context, _pixels.get(), GL_UNSIGNED_BYTE, _traits->width,
                                 _traits->height) == GL_TRUE;
    }

    void destroyNative() override
    {
        if (_context) OSMesaDestroyContext(_context);
        _context = nullptr;
        _pixels.reset();
    }

    UnbindFunction unbindFunction() const override
    {
        return [] { OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); };
    }

private:
    OSMesaContext _context = nullptr;
    std::unique_ptr<unsigned char[]>
        _pixels; ///< buffer to which OSMesa writes the colours at glFinish
};

} // namespace

osg::ref_ptr<osg::GraphicsContext> createOSMesaContext(int width, int height,
                                                       osg::GraphicsContext* sharedContext)
{
    if (!engine::isContextSize("createOSMesaContext", width, height)) return nullptr;
    auto* shared = dynamic_cast<OSMesaPixelContext*>(sharedContext);
    if (sharedContext && !(shared && shared->valid()))
    {
        OSG_WARN << "osgRayTrace: an OSMesa context can only share with an open OSMesa context"
                 << std::endl;
        return nullptr;
    }
    return engine::checkedContext(new OSMesaPixelContext(width, height, shared));
}

} // namespace osgRayTrace
