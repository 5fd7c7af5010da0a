// WindowsTest.cpp - windows, cameras and viewports that come, change and go. Layer: tests.
// SPDX-License-Identifier: MIT
#include "DepthPartition.h"
#include "TestViewer.h"
#include "tests/Catch.h"

#include <osg/GLExtensions>
#include <osg/MatrixTransform>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <malloc.h>
#include <string>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

const osg::Vec4 kGreen(0.0f, 1.0f, 0.0f, 1.0f);
constexpr int kSize = 64;

osg::ref_ptr<RayTracedScene> scene()
{
    osg::ref_ptr<RayTracedScene> scene = tracedScene(unlitSquare(1.0f, kGreen).get());
    scene->addChild(sphere(osg::Vec3(0.0f, 0.0f, -3.0f), 0.5f, osg::Vec4(1, 1, 1, 1)));
    return scene;
}

int greenPixels(const osg::Image& image)
{
    int green = 0;
    for (int y = 0; y < image.t(); ++y)
        for (int x = 0; x < image.s(); ++x)
            green += pixel(image, x, y) == osg::Vec4(0, 255, 0, 255);
    return green;
}

osg::ref_ptr<osg::Camera> windowCamera(osg::GraphicsContext* context)
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setGraphicsContext(context);
    camera->setViewport(0, 0, kSize, kSize);
    return camera;
}

/// Adds and removes, between frames, a camera in the scene graph that draws the scene once more.
/// Nothing else keeps this camera: a frame that is still being drawn keeps only its name.
class NestedCameras : public osg::NodeCallback
{
public:
    /// If ownStages is true, some cameras draw in a stage of their own. OSG 3.6.5 makes its cache
    /// of stages without a lock, so cull threads that meet a new camera at the same time race for
    /// the cache, with ray tracing or without.
    NestedCameras(osg::Node* scene, bool ownStages) : _scene(scene), _ownStages(ownStages) {}

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        osg::Group& group = *node->asGroup();
        const int frame = ++_frame;
        if (frame % 5 == 0) group.removeChildren(0, group.getNumChildren());
        if (frame % 5 == 2)
        {
            osg::ref_ptr<osg::Camera> camera = new osg::Camera;
            camera->setDataVariance(osg::Object::DYNAMIC);
            camera->setRenderOrder(_ownStages && frame % 2 == 0 ? osg::Camera::POST_RENDER
                                                                : osg::Camera::NESTED_RENDER);
            camera->setClearMask(0);
            camera->setViewMatrix(osg::Matrixd::translate(0.01 * frame, 0.0, -1.0));
            camera->addChild(_scene);
            group.addChild(camera);
        }
        traverse(node, visitor);
    }

private:
    osg::ref_ptr<osg::Node> _scene;
    bool _ownStages;
    int _frame = 0;
};

/// Runs for OSGRAYTRACE_STRESS_SECONDS in each threading model, or for a number of frames if the
/// variable is not set.
class Frames
{
public:
    explicit Frames(int count) : _count(count)
    {
        if (const char* seconds = std::getenv("OSGRAYTRACE_STRESS_SECONDS"))
            _seconds = std::atof(seconds);
    }

    bool more(int frame) const
    {
        if (_seconds <= 0.0) return frame < _count;
        const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - _start;
        return passed.count() < _seconds;
    }

    double seconds() const { return _seconds; } ///< 0: a number of frames

private:
    int _count;
    double _seconds = 0.0;
    std::chrono::steady_clock::time_point _start = std::chrono::steady_clock::now();
};

/// Counts OpenGL's objects in contexts that share them.
struct GlObjects
{
    int textures = 0, buffers = 0, programs = 0, shaders = 0;

    int total() const { return textures + buffers + programs + shaders; }
};

GlObjects countObjects(osg::GraphicsContext& context)
{
    REQUIRE(context.makeCurrent());
    const osg::GLExtensions& gl = *context.getState()->get<osg::GLExtensions>();
    GlObjects count;
    for (GLuint name = 1; name < 4096; ++name) // more names than all windows use
    {
        count.textures += glIsTexture(name) == GL_TRUE;
        count.buffers += gl.glIsBuffer(name) == GL_TRUE;
        count.programs += gl.glIsProgram(name) == GL_TRUE;
        count.shaders += gl.glIsShader(name) == GL_TRUE;
    }
    context.releaseContext();
    return count;
}

/// Fills glibc's cache of free blocks of the calling thread. Cached blocks count as used, so the
/// thread is made to keep as many as it may, which is 7 of each size: their number is then always
/// the same.
void fillHeapCache()
{
    constexpr int kMost = 7;
    void* volatile blocks[kMost];
    for (std::size_t size = 24; size <= 1032; size += 16)
    {
        for (int i = 0; i < kMost; ++i)
            blocks[i] = std::malloc(size);
        for (int i = 0; i < kMost; ++i)
            std::free(blocks[i]);
    }
}

/// Returns the bytes of the heap that are in use.
std::size_t heapBytes()
{
    fillHeapCache();
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

} // namespace

TEST_CASE("windows: resized and closed, cameras made and deleted, in all threading models", "[gl]")
{
    const auto model = GENERATE(osgViewer::ViewerBase::SingleThreaded,
                                osgViewer::ViewerBase::CullDrawThreadPerContext,
                                osgViewer::ViewerBase::DrawThreadPerContext,
                                osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext);
    const osg::ref_ptr<RayTracedScene> traced = scene();
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(traced);
    osg::ref_ptr<osg::Group> nested = new osg::Group;
    nested->setDataVariance(osg::Object::DYNAMIC);
    nested->setCullingActive(false);
    const bool oneCulls = model == osgViewer::ViewerBase::SingleThreaded ||
                          model == osgViewer::ViewerBase::DrawThreadPerContext;
    nested->addUpdateCallback(new NestedCameras(traced.get(), oneCulls));
    root->addChild(nested);

    osgViewer::Viewer viewer;
    viewer.getCamera()->setProjectionMatrixAsPerspective(40.0, 1.0, 1.0, 100.0);
    viewer.getCamera()->setViewMatrixAsLookAt(osg::Vec3d(0, 0, 10), osg::Vec3d(),
                                              osg::Vec3d(0, 1, 0));
    const osg::ref_ptr<osg::GraphicsContext> windows[] = {createOSMesaContext(kSize, kSize),
                                                          createOSMesaContext(kSize, kSize)};
    const osg::ref_ptr<FrameCapture> captures[] = {new FrameCapture, new FrameCapture};
    for (int i = 0; i < 2; ++i)
        viewer.addSlave(windowCamera(windows[i].get()).get(), osg::Matrixd(),
                        osg::Matrixd::rotate(0.05 * i, 0, 1, 0));
    viewer.setThreadingModel(model);
    viewer.setSceneData(root.get());
    viewer.realize();

    const Frames frames(40);
    int resizes = 0;
    for (int frame = 0; frames.more(frame); ++frame)
    {
        viewer.frame();
        // Draw threads may still be at work on this frame. So the values of the viewport are
        // changed, as osgViewer does when a window is resized: a new viewport object would change
        // the camera's state set, which draw threads traverse.
        if (frame % 10 != 9) // now and then the size stays
            for (unsigned int i = 0; i < 2; ++i)
            {
                const int width = kSize / 2 + frame * 7 % (kSize / 2),
                          height = kSize - frame * 5 % 20;
                viewer.getSlave(i)._camera->setViewport(0, 0, width, height);
                ++resizes;
            }
        if (frame % 20 == 9)
        {
            // A third camera comes into the first window, and goes again.
            viewer.stopThreading();
            osg::ref_ptr<osg::Camera> camera = windowCamera(windows[0].get());
            camera->setViewport(kSize / 2, 0, kSize / 2, kSize / 2);
            viewer.addSlave(camera.get());
            viewer.startThreading();
        }
        if (frame % 20 == 19)
        {
            viewer.stopThreading();
            viewer.removeSlave(2);
            viewer.startThreading();
        }
    }
    if (frames.seconds() > 0.0)
        std::cout << resizes / frames.seconds() << " resizes a second" << std::endl;
    viewer.stopThreading();
    while (viewer.getNumSlaves() > 2)
        viewer.removeSlave(2);
    nested->removeChildren(0, nested->getNumChildren());
    nested->setUpdateCallback(nullptr);
    for (unsigned int i = 0; i < 2; ++i)
    {
        // The callbacks are added only now, because a capture reads its camera's viewport while it
        // draws.
        osg::Camera& camera = *viewer.getSlave(i)._camera;
        camera.setViewport(0, 0, kSize, kSize);
        camera.addFinalDrawCallback(captures[i].get());
    }
    viewer.startThreading();
    for (int frame = 0; frame < 3; ++frame)
        viewer.frame();
    viewer.stopThreading();

    CHECK(traced->getDrawable()->getStatistics().ok);
    for (const osg::ref_ptr<FrameCapture>& capture : captures)
        CHECK(greenPixels(*capture->getColorImage()) > kSize * kSize / 25);
}

namespace
{

struct Left
{
    GlObjects open;     ///< while the last window is open
    GlObjects objects;  ///< the most after any window was closed
    double bytes = 0.0; ///< growth of the heap by a window
};

/// Returns the growth of the heap by a window, as the median over stretches of windows: a leak of
/// one window is one of each window.
double growth(const std::vector<std::size_t>& heap)
{
    constexpr std::size_t kStretch = 12;
    std::vector<double> grown;
    for (std::size_t i = kStretch; i < heap.size(); ++i)
        grown.push_back((double(heap[i]) - double(heap[i - kStretch])) / kStretch);
    std::nth_element(grown.begin(), grown.begin() + grown.size() / 2, grown.end());
    return grown[grown.size() / 2];
}

/// Opens windows on the scene and closes them, after a few windows in which objects are made that
/// are made only once.
Left openAndClose(osg::Node* node, osg::GraphicsContext& keeper, int cycles)
{
    constexpr int kWarm = 12;
    Left left;
    std::vector<std::size_t> heap;
    for (int cycle = -kWarm; cycle < cycles; ++cycle)
    {
        {
            const osg::ref_ptr<osg::GraphicsContext> window =
                createOSMesaContext(kSize, kSize, &keeper);
            TestViewer view(kSize, kSize, node, window);
            REQUIRE(greenPixels(*view.frames(1 + std::abs(cycle) % 3)) > 100);
            if (cycle + 1 == cycles) left.open = countObjects(*window);
            window->close();
        }
        if (cycle >= 0) heap.push_back(heapBytes());
        const GlObjects now = countObjects(keeper);
        left.objects.textures = std::max(left.objects.textures, now.textures);
        left.objects.buffers = std::max(left.objects.buffers, now.buffers);
        left.objects.programs = std::max(left.objects.programs, now.programs);
        left.objects.shaders = std::max(left.objects.shaders, now.shaders);
    }
    left.bytes = growth(heap);
    return left;
}

} // namespace

TEST_CASE("windows: a hundred that are opened and closed leave nothing behind", "[gl]")
{
    // All windows share their objects with a context that stays, so that the objects that are left
    // can be counted.
    const osg::ref_ptr<osg::GraphicsContext> keeper = createOSMesaContext(8, 8);
    REQUIRE(keeper);
    REQUIRE(keeper->realize());
    const osg::ref_ptr<RayTracedScene> traced = scene();
    traced->getSettings()->setThreads(1); // other threads keep blocks of the heap, too
    const Left left = openAndClose(traced.get(), *keeper, 100);
    const osg::ref_ptr<osg::Node> plain = unlitSquare(1.0f, kGreen);
    const Left osgAlone = kSanitized ? Left() : openAndClose(plain.get(), *keeper, 100);
    std::cout << "100 windows left " << left.objects.total() << " OpenGL objects and " << left.bytes
              << " bytes each, those of OSG alone " << osgAlone.objects.total() << " and "
              << osgAlone.bytes << std::endl;
    CHECK(left.open.textures >= 2);
    CHECK(left.open.buffers >= 1);
    CHECK(left.open.programs >= 1);
    CHECK(left.open.shaders >= 2);
    CHECK(left.objects.textures == 0);
    CHECK(left.objects.buffers == 0);
    CHECK(left.objects.programs == 0);
    CHECK(left.objects.shaders == 0);
    // Under sanitizers the heap is the sanitizer's, which finds leaks by itself.
    CHECK(left.bytes - osgAlone.bytes < 100.0);
    traced->releaseGLObjects();
}
