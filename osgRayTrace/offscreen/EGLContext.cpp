// EGLContext.cpp - OpenGL without a display server, by EGL. Layer: offscreen.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/offscreen/PixelContext.h"
#include <osgRayTrace/offscreen/OffscreenContext>

#include <osg/Notify>

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <string>

namespace osgRayTrace
{

namespace
{

EGLDisplay openDisplay()
{
    EGLDisplay display = EGL_NO_DISPLAY;
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (extensions &&
        std::string(extensions).find("EGL_MESA_platform_surfaceless") != std::string::npos)
    {
        display =
            eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    }
    if (display == EGL_NO_DISPLAY) display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr))
        return EGL_NO_DISPLAY;
    return display;
}

/// Returns the one such display that EGL has in a process, whoever asks for it. Nobody calls
/// eglTerminate, which would close the display for its other users.
EGLDisplay sharedDisplay()
{
    static const EGLDisplay display = openDisplay();
    return display;
}

EGLConfig chooseConfig(EGLDisplay display)
{
    // clang-format off
    const EGLint wanted[] = {
        EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
        EGL_RED_SIZE, 8, EGL_GREEN_SIZE, 8, EGL_BLUE_SIZE, 8, EGL_ALPHA_SIZE, 8,
        EGL_DEPTH_SIZE, 24, EGL_STENCIL_SIZE, 8, EGL_NONE};
    // clang-format on
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || count < 1) return nullptr;
    return config;
}

class EGLPixelContext : public engine::PixelContext
{
public:
    EGLPixelContext(int width, int height, EGLPixelContext* sharedContext)
        : PixelContext(width, height, sharedContext), _display(sharedDisplay())
    {
        if (_display == EGL_NO_DISPLAY || !eglBindAPI(EGL_OPENGL_API)) return;
        const EGLConfig config = chooseConfig(_display);
        if (!config) return;

        const EGLint size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
        _surface = eglCreatePbufferSurface(_display, config, size);
        if (_surface == EGL_NO_SURFACE) return;
        _context = eglCreateContext(
            _display, config, sharedContext ? sharedContext->_context : EGL_NO_CONTEXT, nullptr);
    }

    const char* className() const override { return "EGLContext"; }
    bool valid() const override { return _context != EGL_NO_CONTEXT; }

protected:
    ~EGLPixelContext() override { close(); }

    bool bindNative() override
    {
        // Each thread has its own current API.
        return eglBindAPI(EGL_OPENGL_API) && eglMakeCurrent(_display, _surface, _surface, _context);
    }

    void destroyNative() override
    {
        if (_context != EGL_NO_CONTEXT) eglDestroyContext(_display, _context);
        if (_surface != EGL_NO_SURFACE) eglDestroySurface(_display, _surface);
        _context = EGL_NO_CONTEXT;
        _surface = EGL_NO_SURFACE;
    }

    UnbindFunction unbindFunction() const override
    {
        return []
        { eglMakeCurrent(sharedDisplay(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); };
    }

private:
    EGLDisplay _display = EGL_NO_DISPLAY;
    EGLSurface _surface = EGL_NO_SURFACE;
    EGLContext _context = EGL_NO_CONTEXT;
};

} // namespace

osg::ref_ptr<osg::GraphicsContext> createEGLContext(int width, int height,
                                                    osg::GraphicsContext* sharedContext)
{
    if (!engine::isContextSize("createEGLContext", width, height)) return nullptr;
    auto* shared = dynamic_cast<EGLPixelContext*>(sharedContext);
    if (sharedContext && !(shared && shared->valid()))
    {
        OSG_WARN << "osgRayTrace: an EGL context can only share with an open EGL context"
                 << std::endl;
        return nullptr;
    }
    return engine::checkedContext(new EGLPixelContext(width, height, shared));
}

} // namespace osgRayTrace
