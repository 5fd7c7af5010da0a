// OffscreenTest.cpp - OSMesa and EGL contexts, alone and together. Layer: offscreen.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include <osgRayTrace/offscreen/FrameCapture>
#include <osgRayTrace/offscreen/OffscreenContext>

#include <osg/Geometry>
#include <osg/Program>
#include <osg/Texture2D>
#include <osgUtil/SceneView>
#include <osgViewer/Viewer>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#if defined(__GLIBC__)
#include <malloc.h>
#endif
#include <unistd.h>
#include <vector>

using osgRayTrace::createEGLContext;
using osgRayTrace::createOSMesaContext;
using osgRayTrace::FrameCapture;

namespace
{

using Context = osg::ref_ptr<osg::GraphicsContext>;
using CreateFunction = Context (*)(int, int, osg::GraphicsContext*);

const CreateFunction kCreateFunctions[] = {createOSMesaContext, createEGLContext};

const osg::Vec4 kClearColor(0.2f, 0.4f, 0.6f, 1.0f);
const osg::Vec4 kQuadColor(1.0f, 0.6f, 0.0f, 1.0f);

/// Returns a quad in the middle half of the view, a quarter of the way from the near to the far
/// plane.
osg::ref_ptr<osg::Geometry> makeQuad(const osg::Vec4& color = kQuadColor)
{
    osg::ref_ptr<osg::Geometry> quad = osg::createTexturedQuadGeometry(
        osg::Vec3(-0.5f, -0.5f, 0.5f), osg::Vec3(1, 0, 0), osg::Vec3(0, 1, 0));
    quad->setColorArray(new osg::Vec4Array(1, &color), osg::Array::BIND_OVERALL);
    quad->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return quad;
}

/// Sets the same colour by GLSL: OSG finds GLSL's entry points in another way than those of OpenGL
/// 1.
void addGlsl(osg::StateSet& stateSet)
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(
        osg::Shader::VERTEX,
        "varying vec4 color; void main() { color = gl_Color; gl_Position = ftransform(); }"));
    program->addShader(new osg::Shader(
        osg::Shader::FRAGMENT,
        "uniform float scale; varying vec4 color; void main() { gl_FragColor = color * scale; }"));
    stateSet.setAttributeAndModes(program);
    stateSet.addUniform(new osg::Uniform("scale", 1.0f));
}

void setUpCamera(osg::Camera& camera, osg::GraphicsContext* context)
{
    camera.setGraphicsContext(context);
    camera.setViewport(0, 0, context->getTraits()->width, context->getTraits()->height);
    camera.setComputeNearFarMode(osg::Camera::DO_NOT_COMPUTE_NEAR_FAR);
    camera.setProjectionMatrixAsOrtho(-1, 1, -1, 1, -1, 1);
    camera.setViewMatrix(osg::Matrixd());
    camera.setClearColor(kClearColor);
}

/// Holds a viewer of a scene in a context, and its pictures.
struct View
{
    explicit View(osg::GraphicsContext* context, osg::Node* scene = makeQuad().get(),
                  osgViewer::Viewer::ThreadingModel threading = osgViewer::Viewer::SingleThreaded)
        : capture(new FrameCapture)
    {
        viewer.setThreadingModel(threading);
        viewer.setLightingMode(osg::View::NO_LIGHT);
        setUpCamera(*viewer.getCamera(), context);
        viewer.getCamera()->addFinalDrawCallback(capture);
        viewer.setSceneData(scene);
        viewer.realize();
    }

    osgViewer::Viewer viewer;
    osg::ref_ptr<FrameCapture> capture;
};

bool hasColor(const osg::Image& image, int x, int y, const osg::Vec4& expected)
{
    const unsigned char* pixel = image.data(x, y);
    for (int channel = 0; channel < 4; ++channel)
    {
        if (std::abs(pixel[channel] - expected[channel] * 255.0f) > 0.6f) return false;
    }
    return true;
}

void requireQuad(FrameCapture& capture, int width, int height)
{
    const osg::Image& color = *capture.getColorImage();
    const osg::Image& depth = *capture.getDepthImage();
    REQUIRE(color.s() == width);
    REQUIRE(color.t() == height);
    REQUIRE(depth.s() == width);
    REQUIRE(depth.t() == height);

    REQUIRE(hasColor(color, width / 2, height / 2, kQuadColor));
    // The buffer has 24 bits of depth; depths are compared to half a step.
    const auto depthAt = [&](int x, int y)
    { return *reinterpret_cast<const float*>(depth.data(x, y)); };
    REQUIRE(depthAt(width / 2, height / 2) == Approx(0.25).margin(0.6 / (1 << 24)));
    if (width < 4 || height < 4) return;
    REQUIRE(hasColor(color, 0, 0, kClearColor));
    REQUIRE(hasColor(color, width - 1, height - 1, kClearColor));
    REQUIRE(depthAt(0, 0) == 1.0f);
}

/// Returns the resident memory without what malloc keeps for later. Whether a freed image is used
/// again or cut up depends on the order in which Mesa's threads free their images; on a busy
/// machine none was used again.
std::size_t residentBytes()
{
#if defined(__GLIBC__)
    malloc_trim(0);
#endif
    std::size_t total = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> total >> resident;
    return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

} // namespace

TEST_CASE("offscreen: osgViewer draws colour and depth in both kinds of context", "[offscreen][gl]")
{
    for (const CreateFunction create : kCreateFunctions)
    {
        const Context context = create(64, 48, nullptr);
        REQUIRE(context);
        INFO(context->className());
        View view(context.get());
        REQUIRE(context->isRealized());
        for (int frame = 0; frame < 3; ++frame)
            view.viewer.frame();
        requireQuad(*view.capture, 64, 48);
    }
}

TEST_CASE("offscreen: a context of either kind is OpenGL 3 or newer, with buffers as promised",
          "[offscreen][gl]")
{
    for (const CreateFunction create : kCreateFunctions)
    {
        const Context context = create(8, 8, nullptr);
        REQUIRE(context);
        INFO(context->className());
        REQUIRE(context->realize());
        REQUIRE(context->makeCurrent());

        REQUIRE(osg::getGLVersionNumber() >= 3.0f);
        REQUIRE(context->getState()->get<osg::GLExtensions>()->isGlslSupported);
        GLint depthBits = 0, stencilBits = 0;
        glGetIntegerv(GL_DEPTH_BITS, &depthBits);
        glGetIntegerv(GL_STENCIL_BITS, &stencilBits);
        REQUIRE(depthBits == 24);
        REQUIRE(stencilBits == 8);

        // The buffer is the one that osgViewer chooses by the traits.
        glDrawBuffer(context->getTraits()->doubleBuffer ? GL_BACK : GL_FRONT);
        REQUIRE(glGetError() == GL_NO_ERROR);
        REQUIRE(context->releaseContext());
    }
}

TEST_CASE("offscreen: GLSL works in both kinds of context", "[offscreen][gl]")
{
    for (const CreateFunction create : kCreateFunctions)
    {
        const Context context = create(32, 32, nullptr);
        REQUIRE(context);
        INFO(context->className());
        const osg::ref_ptr<osg::Geometry> quad = makeQuad();
        addGlsl(*quad->getOrCreateStateSet());
        View view(context.get(), quad);
        view.viewer.frame();
        requireQuad(*view.capture, 32, 32);

        quad->getStateSet()->getUniform("scale")->set(0.5f);
        view.viewer.frame();
        REQUIRE(hasColor(*view.capture->getColorImage(), 16, 16, kQuadColor * 0.5f));
    }
}

TEST_CASE("offscreen: every threading model of osgViewer works", "[offscreen][gl]")
{
    const osgViewer::Viewer::ThreadingModel models[] = {
        osgViewer::Viewer::SingleThreaded, osgViewer::Viewer::CullDrawThreadPerContext,
        osgViewer::Viewer::DrawThreadPerContext,
        osgViewer::Viewer::CullThreadPerCameraDrawThreadPerContext};
    for (const CreateFunction create : kCreateFunctions)
    {
        for (const osgViewer::Viewer::ThreadingModel model : models)
        {
            const Context context = create(40, 30, nullptr);
            REQUIRE(context);
            INFO(context->className() << ", threading model " << model);
            View view(context.get(), makeQuad(), model);
            for (int frame = 0; frame < 5; ++frame)
                view.viewer.frame();
            view.viewer.stopThreading();
            requireQuad(*view.capture, 40, 30);
        }
    }
}

TEST_CASE("offscreen: a plain SceneView works in both kinds of context", "[offscreen][gl]")
{
    for (const CreateFunction create : kCreateFunctions)
    {
        const Context context = create(32, 32, nullptr);
        REQUIRE(context);
        INFO(context->className());
        REQUIRE(context->realize());
        REQUIRE(context->makeCurrent());

        const osg::ref_ptr<FrameCapture> capture = new FrameCapture;
        osg::ref_ptr<osgUtil::SceneView> sceneView = new osgUtil::SceneView;
        sceneView->setDefaults();
        sceneView->setLightingMode(osgUtil::SceneView::NO_SCENEVIEW_LIGHT);
        sceneView->setState(context->getState());
        setUpCamera(*sceneView->getCamera(), context.get());
        // SceneView's own settings decide here, not its camera's.
        sceneView->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        sceneView->setSceneData(makeQuad().get());
        sceneView->setFrameStamp(new osg::FrameStamp);
        sceneView->update();
        sceneView->cull();
        sceneView->draw();
        osg::RenderInfo renderInfo(context->getState(), nullptr);
        renderInfo.pushCamera(sceneView->getCamera());
        (*capture)(renderInfo);
        requireQuad(*capture, 32, 32);
        sceneView = nullptr;
        context->releaseContext();
    }
}

TEST_CASE("offscreen: sizes from 1 x 1 to 4096 x 4096", "[offscreen][gl]")
{
    const int sizes[][2] = {{1, 1}, {1, 7}, {3, 1}, {333, 5}, {4096, 4096}};
    for (const CreateFunction create : kCreateFunctions)
    {
        for (const auto& size : sizes)
        {
            const Context context = create(size[0], size[1], nullptr);
            REQUIRE(context);
            INFO(context->className() << " " << size[0] << " x " << size[1]);
            View view(context.get());
            view.viewer.frame();
            requireQuad(*view.capture, size[0], size[1]);
        }
    }
}

TEST_CASE("offscreen: what is no size, or too large a one, gives null", "[offscreen]")
{
    const int sizes[][2] = {{0, 8},       {8, 0},       {-1, 8},       {0, 0}, {1 << 30, 1 << 30},
                            {1 << 20, 4}, {4, 1 << 20}, {40000, 40000}};
    for (const CreateFunction create : kCreateFunctions)
    {
        for (const auto& size : sizes)
        {
            INFO(size[0] << " x " << size[1]);
            REQUIRE_FALSE(create(size[0], size[1], nullptr));
        }
    }
}

TEST_CASE("offscreen: both kinds of context take turns in one thread", "[offscreen][gl]")
{
    const Context contexts[] = {createOSMesaContext(20, 20), createEGLContext(20, 20),
                                createEGLContext(20, 20), createOSMesaContext(20, 20)};
    std::vector<std::unique_ptr<View>> views;
    for (const Context& context : contexts)
    {
        REQUIRE(context);
        const osg::ref_ptr<osg::Geometry> quad = makeQuad();
        addGlsl(*quad->getOrCreateStateSet());
        views.push_back(std::make_unique<View>(context.get(), quad));
    }

    for (int frame = 0; frame < 4; ++frame)
    {
        for (std::size_t i = 0; i < views.size(); ++i)
        {
            const osg::Vec4 clearColor(i / 4.0f, frame / 4.0f, 0.5f, 1.0f);
            views[i]->viewer.getCamera()->setClearColor(clearColor);
            views[i]->viewer.frame();
            const osg::Image& image = *views[i]->capture->getColorImage();
            INFO("context " << i << ", frame " << frame);
            REQUIRE(hasColor(image, 0, 0, clearColor));
            REQUIRE(hasColor(image, 10, 10, kQuadColor));
        }
    }

    // No context is released in between: the other kind takes over, and the results stay apart.
    for (int round = 0; round < 3; ++round)
    {
        for (std::size_t i = 0; i < 4; ++i)
        {
            REQUIRE(contexts[i]->makeCurrent());
            glClearColor(i / 4.0f, round / 4.0f, 1.0f, 1.0f);
            glClear(GL_COLOR_BUFFER_BIT);
        }
        for (std::size_t i = 0; i < 4; ++i)
        {
            REQUIRE(contexts[i]->makeCurrent());
            osg::ref_ptr<osg::Image> image = new osg::Image;
            image->readPixels(0, 0, 20, 20, GL_RGBA, GL_UNSIGNED_BYTE);
            REQUIRE(hasColor(*image, 3, 3, osg::Vec4(i / 4.0f, round / 4.0f, 1.0f, 1.0f)));
        }
    }
    for (const Context& context : contexts)
        context->releaseContext();
}

TEST_CASE("offscreen: both kinds of context draw the same picture", "[offscreen][gl]")
{
    osg::ref_ptr<osg::Image> images[2];
    for (int i = 0; i < 2; ++i)
    {
        const Context context = kCreateFunctions[i](101, 67, nullptr);
        REQUIRE(context);
        View view(context.get());
        view.viewer.frame();
        images[i] = view.capture->getColorImage();
    }
    REQUIRE(images[0]->getTotalSizeInBytes() == images[1]->getTotalSizeInBytes());
    REQUIRE(std::memcmp(images[0]->data(), images[1]->data(), images[0]->getTotalSizeInBytes()) ==
            0);
}

TEST_CASE("offscreen: shared contexts share textures", "[offscreen][gl]")
{
    for (const CreateFunction create : kCreateFunctions)
    {
        const Context first = create(16, 16, nullptr);
        REQUIRE(first);
        const Context second = create(16, 16, first.get());
        REQUIRE(second);
        INFO(first->className());
        REQUIRE(first->getState()->getContextID() == second->getState()->getContextID());

        const osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        image->setColor(osg::Vec4(0, 1, 0, 1), 0, 0);
        const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
        texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);

        // The object is uploaded in the first context only; the second context finds it by its
        // contextID.
        REQUIRE(first->realize());
        REQUIRE(first->makeCurrent());
        texture->apply(*first->getState());
        glFinish();
        const GLuint name = texture->getTextureObject(first->getState()->getContextID())->id();
        REQUIRE(first->releaseContext());

        REQUIRE(second->realize());
        REQUIRE(second->makeCurrent());
        REQUIRE(glIsTexture(name));
        unsigned char pixel[4] = {};
        glBindTexture(GL_TEXTURE_2D, name);
        glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
        REQUIRE(pixel[1] == 255);
        REQUIRE(second->releaseContext());
        texture->releaseGLObjects(nullptr);
    }
    const Context osmesa = createOSMesaContext(4, 4);
    REQUIRE_FALSE(createEGLContext(4, 4, osmesa.get()));
}

TEST_CASE("offscreen: a hundred contexts, one after the other, leave nothing behind",
          "[offscreen][gl]")
{
    constexpr int kSide = 1024; // 4 MiB of colour and 4 MiB of depth each
    for (const CreateFunction create : kCreateFunctions)
    {
        std::size_t before = 0;
        unsigned int maxContextId = 0;
        for (int i = 0; i < 100; ++i)
        {
            {
                const Context context = create(kSide, kSide, nullptr);
                REQUIRE(context);
                View view(context.get());
                view.viewer.frame();
                requireQuad(*view.capture, kSide, kSide);
            }
            if (i != 19) continue;
            before = residentBytes();
            maxContextId = osg::GraphicsContext::getMaxContextID();
        }
        REQUIRE(osg::GraphicsContext::getMaxContextID() == maxContextId);
        REQUIRE(osg::GraphicsContext::getAllRegisteredGraphicsContexts().empty());
        // Drivers keep some 100 KiB a context; one forgotten buffer in each context would be 320
        // MiB.
        INFO("grown by " << (double(residentBytes()) - double(before)) / (1 << 20) << " MiB");
        REQUIRE(residentBytes() < before + (std::size_t(80) << 20));
    }
}

TEST_CASE("offscreen: a program that has libGL first gets EGL, and no OSMesa that does nothing",
          "[.][behind-libGL]")
{
    REQUIRE_FALSE(createOSMesaContext(8, 8));
    const Context context = createEGLContext(32, 32);
    REQUIRE(context);
    View view(context.get());
    view.viewer.frame();
    requireQuad(*view.capture, 32, 32);
}
