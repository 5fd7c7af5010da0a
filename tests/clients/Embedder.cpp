// Embedder.cpp - a program with windows and contexts of its own, in which OSG draws: a stand-in for
// the widgets of Qt, FOX and GLUT. Layer: tests.
// SPDX-License-Identifier: MIT
//
// Usage: embedder window|framebuffer|views MODEL MODEL. "window" draws into a window, "framebuffer"
// into a framebuffer object as Qt's widgets do, "views" into a window of several views that come
// and go. All change their size and their scenes while they run.
#include <osg/FrameBufferObject>
#include <osg/GLExtensions>
#include <osgDB/ReadFile>
#include <osgGA/TrackballManipulator>
#include <osgViewer/CompositeViewer>
#include <osgViewer/GraphicsWindow>
#include <osgViewer/Viewer>

#include <GL/glx.h>
#include <X11/Xlib.h>

#include <memory>
#include <string>

namespace
{

constexpr int kResizeFrame = 10, kLastSceneFrame = 20, kAddFrame = 8, kReplaceFrame = 14;

struct Size
{
    int width = 0, height = 0;
};

/// Holds a window of X11's with a context, of which OSG knows nothing.
class ForeignWindow
{
public:
    explicit ForeignWindow(Size size) : _display(XOpenDisplay(nullptr))
    {
        int wanted[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_DEPTH_SIZE, 24, None};
        XVisualInfo* visual = glXChooseVisual(_display, DefaultScreen(_display), wanted);
        const Window root = RootWindow(_display, visual->screen);
        XSetWindowAttributes attributes = {};
        attributes.colormap = XCreateColormap(_display, root, visual->visual, AllocNone);
        _window = XCreateWindow(_display, root, 0, 0, unsigned(size.width), unsigned(size.height),
                                0, visual->depth, InputOutput, visual->visual,
                                CWColormap | CWBorderPixel, &attributes);
        XMapWindow(_display, _window);
        glXMakeCurrent(_display, _window, glXCreateContext(_display, visual, nullptr, True));
        XSync(_display, False);
    }

    void resize(Size size)
    {
        XResizeWindow(_display, _window, unsigned(size.width), unsigned(size.height));
        XSync(_display, False);
    }

    void swap() { glXSwapBuffers(_display, _window); }

private:
    Display* _display;
    Window _window = 0;
};

/// Holds a framebuffer object, as a widget that is composed with others does.
class OwnFramebuffer
{
public:
    OwnFramebuffer(osg::State& state, Size size) : _gl(*state.get<osg::GLExtensions>())
    {
        _gl.glGenFramebuffers(1, &_name);
        _gl.glGenRenderbuffers(2, _buffers);
        resize(size);
    }

    void resize(Size size)
    {
        const GLenum formats[] = {GL_RGBA8, GL_DEPTH24_STENCIL8_EXT};
        for (int i = 0; i < 2; ++i)
        {
            _gl.glBindRenderbuffer(GL_RENDERBUFFER_EXT, _buffers[i]);
            _gl.glRenderbufferStorage(GL_RENDERBUFFER_EXT, formats[i], size.width, size.height);
        }
        bind();
        _gl.glFramebufferRenderbuffer(GL_FRAMEBUFFER_EXT, GL_COLOR_ATTACHMENT0_EXT,
                                      GL_RENDERBUFFER_EXT, _buffers[0]);
        _gl.glFramebufferRenderbuffer(GL_FRAMEBUFFER_EXT, GL_DEPTH_ATTACHMENT_EXT,
                                      GL_RENDERBUFFER_EXT, _buffers[1]);
    }

    void bind() { _gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, _name); }
    GLuint name() const { return _name; }

private:
    osg::GLExtensions& _gl;
    GLuint _name = 0, _buffers[2] = {};
};

void setUp(osgViewer::View& view, osgViewer::GraphicsWindow& window, int x, Size size,
           osg::Node* scene)
{
    osg::Camera& camera = *view.getCamera();
    camera.setGraphicsContext(&window);
    camera.setViewport(x, 0, size.width, size.height);
    camera.setProjectionMatrixAsPerspective(30.0, double(size.width) / size.height, 1.0, 1000.0);
    view.setCameraManipulator(new osgGA::TrackballManipulator);
    view.setSceneData(scene);
}

/// Runs a viewer that gets another scene every third frame, and another size once.
int runViewer(bool inFramebuffer, osg::Node& first, osg::Node& second)
{
    ForeignWindow window({320, 240});
    osgViewer::Viewer viewer;
    osg::ref_ptr<osgViewer::GraphicsWindowEmbedded> embedded =
        viewer.setUpViewerAsEmbeddedInWindow(0, 0, 320, 240);
    setUp(viewer, *embedded, 0, {320, 240}, &first);
    viewer.realize();
    std::unique_ptr<OwnFramebuffer> framebuffer;
    if (inFramebuffer)
    {
        embedded->getState()->initializeExtensionProcs();
        framebuffer = std::make_unique<OwnFramebuffer>(*embedded->getState(), Size{320, 240});
        embedded->setDefaultFboId(framebuffer->name());
    }
    for (int frame = 1; !viewer.done(); ++frame)
    {
        if (frame == kResizeFrame)
        {
            const Size size{280, 300};
            window.resize(size);
            embedded->resized(0, 0, size.width, size.height);
            embedded->getEventQueue()->windowResize(0, 0, size.width, size.height);
            if (framebuffer) framebuffer->resize(size);
        }
        if (frame <= kLastSceneFrame && frame % 3 == 0)
            viewer.setSceneData(frame % 2 ? &first : &second);
        if (framebuffer) framebuffer->bind();
        viewer.frame();
        window.swap();
    }
    return 0;
}

/// Runs a composite viewer whose views come and go.
int runViews(osg::Node& first, osg::Node& second)
{
    ForeignWindow window({320, 240});
    osgViewer::CompositeViewer viewer;
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    const osg::ref_ptr<osgViewer::GraphicsWindowEmbedded> embedded =
        new osgViewer::GraphicsWindowEmbedded(0, 0, 320, 240);
    const auto add = [&](int x, int width, osg::Node& scene)
    {
        osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
        setUp(*view, *embedded, x, {width, 240}, &scene);
        viewer.addView(view.get());
        return view;
    };
    osg::ref_ptr<osgViewer::View> left = add(0, 160, first);
    viewer.realize();
    for (int frame = 1; !viewer.done(); ++frame)
    {
        if (frame == kAddFrame) add(160, 160, first); // shares the scene of the first view
        if (frame == kReplaceFrame)
        {
            viewer.removeView(left.get());
            left = add(0, 160, second);
        }
        viewer.frame();
        window.swap();
    }
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 4) return 1;
    const std::string how = argv[1];
    const osg::ref_ptr<osg::Node> first = osgDB::readRefNodeFile(argv[2]);
    const osg::ref_ptr<osg::Node> second = osgDB::readRefNodeFile(argv[3]);
    if (!first || !second) return 1;
    if (how == "views") return runViews(*first, *second);
    return runViewer(how == "framebuffer", *first, *second);
}
