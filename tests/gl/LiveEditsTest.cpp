// LiveEditsTest.cpp - graphs that are edited between frames, in all threading models. Layer: tests.
// SPDX-License-Identifier: MIT
#include "TestViewer.h"
#include "tests/Catch.h"
#include "tests/bridge/GraphEditor.h"
#include "tests/fuzz/FuzzSeeds.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/EnvironmentLight>

#include <osg/LightSource>
#include <osg/observer_ptr>
#include <osgViewer/CompositeViewer>

#include <algorithm>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

constexpr int kSize = 24;
constexpr int kFrames = 1500;
constexpr int kCompared = 100; ///< frames from one comparison to the next

osg::ref_ptr<osg::Image> smallImage()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 2, 1, GL_RGB, GL_FLOAT);
    std::fill_n(reinterpret_cast<float*>(image->data()), 24, 0.5f);
    return image;
}

osg::ref_ptr<AreaLight> ceilingLight()
{
    return new AreaLight(osg::Vec3(-1.0f, -1.0f, 3.0f), osg::Vec3(0.0f, 1.0f, 0.0f),
                         osg::Vec3(1.0f, 0.0f, 0.0f), osg::Vec3(5.0f, 5.0f, 5.0f));
}

osg::ref_ptr<RayTracedScene> sceneOf(osg::Node* graph)
{
    osg::ref_ptr<RayTracedScene> scene = tracedScene(graph);
    scene->getSettings()->setThreads(1);
    scene->getSettings()->setMaxPasses(1);
    return scene;
}

/// Returns a view of the graph from a side of its own.
osg::ref_ptr<osgViewer::View> newView(int number, osg::ref_ptr<FrameCapture>& capture)
{
    osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
    capture = new FrameCapture;
    osg::Camera& camera = *view->getCamera();
    camera.setGraphicsContext(createOSMesaContext(kSize, kSize).get());
    camera.setViewport(0, 0, kSize, kSize);
    camera.setClearColor(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    camera.setComputeNearFarMode(osg::Camera::DO_NOT_COMPUTE_NEAR_FAR);
    camera.setProjectionMatrixAsPerspective(40.0, 1.0, 1.0, 100.0);
    camera.setViewMatrixAsLookAt(osg::Vec3d(0.7 * number, -1.0, 6.0), osg::Vec3d(),
                                 osg::Vec3d(0.0, 1.0, 0.0));
    camera.addFinalDrawCallback(capture);
    return view;
}

/// Shows the scene in several views, each in a context of its own.
struct Viewers
{
    explicit Viewers(int count) : captures(static_cast<std::size_t>(count))
    {
        for (int i = 0; i < count; ++i)
        {
            views.push_back(newView(i, captures[std::size_t(i)]));
            viewer.addView(views.back());
        }
    }

    void show(osg::Node* scene)
    {
        for (const osg::ref_ptr<osgViewer::View>& view : views)
            view->setSceneData(scene);
    }

    osgViewer::CompositeViewer viewer;
    std::vector<osg::ref_ptr<osgViewer::View>> views;
    std::vector<osg::ref_ptr<FrameCapture>> captures;
};

int differentPixels(const osg::Image& a, const osg::Image& b)
{
    int count = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
        {
            int apart = 0;
            for (int c = 0; c < 3; ++c)
                apart = std::max(apart, std::abs(int(a.data(x, y)[c]) - int(b.data(x, y)[c])));
            count += apart > 2;
        }
    return count;
}

/// In at most this many pixels rounding decides which side of an edge a ray passes.
constexpr int kRoundedPixels = 5;

/// Edits a graph between the frames of a viewer; now and then the viewer's pictures must be those
/// of a scene that has just been converted.
void editLive(uint32_t seed, osgViewer::ViewerBase::ThreadingModel model, int viewCount)
{
    osg::ref_ptr<osg::Group> graph = new osg::Group;
    GraphEditor editor(*graph, seed);
    osg::ref_ptr<RayTracedScene> scene = sceneOf(graph);
    Viewers live(viewCount), fresh(viewCount);
    live.viewer.setThreadingModel(model);
    live.show(scene);
    live.viewer.realize();
    fresh.viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    for (int frame = 1; frame <= kFrames; ++frame)
    {
        editor.edit();
        if (frame % 7 == 0) editor.edit(); // two edits in one frame
        live.viewer.frame();
        if (frame % kCompared) continue;
        CAPTURE(seed, frame, model, viewCount, editor.last());
        live.viewer.stopThreading();
        REQUIRE(scene->getDrawable()->getStatistics().ok);
        const osg::ref_ptr<RayTracedScene> converted = sceneOf(graph);
        fresh.show(converted);
        fresh.viewer.frame();
        for (int i = 0; i < viewCount; ++i)
        {
            CAPTURE(i);
            REQUIRE(differentPixels(*live.captures[std::size_t(i)]->getColorImage(),
                                    *fresh.captures[std::size_t(i)]->getColorImage()) <=
                    kRoundedPixels);
        }
        fresh.show(nullptr);
        live.viewer.startThreading();
    }
    live.viewer.stopThreading();
}

void editLiveInAllViews(osgViewer::ViewerBase::ThreadingModel model)
{
    forEachSeed(1, [&](uint32_t seed) { editLive(seed, model, 1); });
    forEachSeed(1, [&](uint32_t seed) { editLive(seed, model, 4); });
}

} // namespace

TEST_CASE("live edits: one light replaces another in a frame", "[gl]")
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    osg::ref_ptr<osg::Image> image = smallImage();
    group->addChild(sphere(osg::Vec3(), 0.5f, osg::Vec4(1, 1, 1, 1)));
    group->addChild(ceilingLight());
    TestViewer viewer(kSize, kSize, sceneOf(group));
    for (int i = 0; i < 50; ++i)
    {
        group->removeChildren(1, 1);
        if (i % 2)
            group->addChild(new EnvironmentLight(image));
        else
            group->addChild(ceilingLight());
        const osg::ref_ptr<osg::Image> picture = viewer.frames(1);
        if (i < 46) continue;
        TestViewer fresh(kSize, kSize, sceneOf(group));
        CHECK(differentPixels(*picture, *fresh.frames(1)) <= kRoundedPixels);
    }
}

TEST_CASE("live edits: what is removed is freed with the next frame", "[gl]")
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    osg::ref_ptr<RayTracedScene> scene = sceneOf(group);
    TestViewer viewer(kSize, kSize, scene);
    const osg::ref_ptr<RayTraceDrawable> drawable = scene->getDrawable();
    const auto addOne = [&group]
    {
        const osg::ref_ptr<osg::Geometry> square = unlitSquare(0.5f, osg::Vec4(1, 1, 1, 1));
        osg::ref_ptr<osg::LightSource> light = new osg::LightSource; // comes with its children
        light->addChild(square);
        group->addChild(light);
        return osg::observer_ptr<osg::Geometry>(square);
    };
    SECTION("while it is traced")
    {
        const osg::observer_ptr<osg::Geometry> square = addOne();
        viewer.frames(2);
        group->removeChildren(0, 1);
        viewer.frames(1);
        viewer.frames(1); // until then OSG's render stage refers to what it drew
        CHECK(!square.valid());
    }
    SECTION("while ray tracing is switched off")
    {
        const osg::observer_ptr<osg::Geometry> square = addOne();
        viewer.frames(2);
        scene->setEnabled(false);
        viewer.frames(1);
        group->removeChildren(0, 1);
        viewer.frames(2);
        CHECK(!square.valid());
        scene->setEnabled(true);
        addOne();
        viewer.frames(1);
        CHECK(scene->getDrawable()->getStatistics().ok);
    }
    SECTION("with the scene, also if its drawable is kept")
    {
        const osg::observer_ptr<osg::Geometry> square = addOne();
        const osg::observer_ptr<RayTracedScene> whole = scene;
        viewer.frames(2);
        viewer.viewer.setSceneData(nullptr);
        viewer.frames(2);
        scene = nullptr;
        group = nullptr;
        CHECK(!whole.valid());
        CHECK(!square.valid());
    }
}

TEST_CASE("live edits: random ones in one thread", "[gl][live-edits]")
{
    editLiveInAllViews(osgViewer::ViewerBase::SingleThreaded);
}

TEST_CASE("live edits: random ones with a thread for each context", "[gl][live-edits]")
{
    editLiveInAllViews(osgViewer::ViewerBase::CullDrawThreadPerContext);
}

TEST_CASE("live edits: random ones with draw threads", "[gl][live-edits]")
{
    editLiveInAllViews(osgViewer::ViewerBase::DrawThreadPerContext);
}

TEST_CASE("live edits: random ones with cull and draw threads", "[gl][live-edits]")
{
    editLiveInAllViews(osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext);
}
