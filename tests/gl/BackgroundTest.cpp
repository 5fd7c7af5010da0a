// BackgroundTest.cpp - pictures that workers trace while a viewer goes on drawing. Layer: tests.
// SPDX-License-Identifier: MIT
#include "TestViewer.h"
#include "tests/Catch.h"

#include <chrono>
#include <cstdlib>
#include <thread>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

constexpr int kSize = 64;
const osg::Vec4 kGreen(0.0f, 1.0f, 0.0f, 1.0f);

osg::ref_ptr<RayTracedScene> ballScene(RayTraceSettings::Presentation presentation, int maxPasses)
{
    osg::ref_ptr<RayTracedScene> scene = tracedScene(sphere(osg::Vec3(), 2.5f, kGreen).get());
    scene->getSettings()->setPresentation(presentation);
    scene->getSettings()->setMaxPasses(maxPasses);
    return scene;
}

/// Returns a scene whose workers need half an hour for the first image, and a moment for each tile.
osg::ref_ptr<RayTracedScene> endlessScene()
{
    osg::ref_ptr<RayTracedScene> scene = ballScene(RayTraceSettings::BACKGROUND, 1 << 24);
    RayTraceSettings& settings = *scene->getSettings();
    settings.setShadows(true);
    settings.setLightAngle(20.0f);
    settings.setLightSamples(4096);
    settings.setPassesPerFrame(1024); // in force without a budget
    return scene;
}

Statistics statistics(const RayTracedScene& scene)
{
    return scene.getDrawable()->getStatistics();
}

osg::Vec3d eyeAt(int i)
{
    return osg::Vec3d(0.4 * (i % 5), 0.3 * (i % 3), 10.0);
}

/// Draws until the condition holds; gives up after more frames than any machine should need.
template <class Condition> bool framesUntil(TestViewer& view, const Condition& condition)
{
    for (int i = 0; i < 20000; ++i)
    {
        view.viewer.frame();
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

/// Returns whether there is no image yet.
bool isBlack(const osg::Image& image)
{
    for (int y = 0; y < image.t(); ++y)
        for (int x = 0; x < image.s(); ++x)
            if (pixel(image, x, y) != osg::Vec4(0, 0, 0, 255)) return false;
    return true;
}

} // namespace

TEST_CASE("background: the picture at rest is that of a frame-locked view, bit by bit", "[gl]")
{
    osg::ref_ptr<RayTracedScene> locked = ballScene(RayTraceSettings::FRAME_LOCKED, 6);
    TestViewer exact(kSize, kSize, locked.get());
    const osg::ref_ptr<osg::Image> expected = exact.frames(7);
    REQUIRE(statistics(*locked).passes == 6);
    CHECK(statistics(*locked).presentation == "frame-locked");

    osg::ref_ptr<RayTracedScene> scene = ballScene(RayTraceSettings::BACKGROUND, 6);
    const float budget = GENERATE(0.0f, 1e-3f, 33.0f);
    scene->getSettings()->setFrameBudget(budget);
    TestViewer view(kSize, kSize, scene.get());
    const auto isDone = [&]
    {
        const Statistics now =
            statistics(*scene); // a budget may give a slow machine fewer pixels at first
        return now.passes == 6 && now.resolutionDivider == 1;
    };
    REQUIRE(framesUntil(view, isDone));
    CHECK(equal(*view.frames(2), *expected));
    CHECK(view.depth(kSize / 2, kSize / 2) == exact.depth(kSize / 2, kSize / 2));
    CHECK(statistics(*scene).presentation == "background");
    CHECK(statistics(*scene).imageAge == 0);
    CHECK(scene->getDrawable()->getColorImage());

    // A change of the exposure reaches the display, too.
    locked->getSettings()->setExposure(1.0f);
    scene->getSettings()->setExposure(1.0f);
    const osg::ref_ptr<osg::Image> brighter = exact.frames();
    CHECK(framesUntil(view, [&] { return equal(*view.frames(), *brighter); }));
}

TEST_CASE(
    "background: draw does not wait for an image, whatever the view does, and nor does who goes",
    "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = endlessScene();
    {
        TestViewer view(kSize, kSize, scene.get());
        for (int i = 0; i < 200; ++i)
        {
            view.look(eyeAt(i));
            view.frames();
        }
        CHECK(isBlack(*view.frames()));
        CHECK(statistics(*scene).ok);
        CHECK(statistics(*scene).passes == 0); // otherwise draw would have waited

        SECTION("a camera")
        {
            osg::ref_ptr<osg::Camera> second = new osg::Camera;
            second->setGraphicsContext(view.camera().getGraphicsContext());
            second->setViewport(0, 0, kSize / 2, kSize / 2);
            view.viewer.addSlave(second.get());
            view.frames(3);
            view.viewer.removeSlave(0);
            second = nullptr;
            view.frames(300); // the camera's view is forgotten
        }
        SECTION("the scene")
        {
            osg::observer_ptr<RayTracedScene> gone(scene);
            view.viewer.setSceneData(new osg::Group);
            scene = nullptr;
            view.frames(2);
            CHECK_FALSE(gone.valid());
        }
        SECTION("the window")
        {
            osg::ref_ptr<osg::GraphicsContext> window = view.camera().getGraphicsContext();
            window->close();
        }
        SECTION("what is below it")
        {
            scene->removeChildren(0, scene->getNumChildren());
            view.frames(2);
            scene->addChild(unlitSquare(1.0f, kGreen));
            view.frames(2);
        }
        SECTION("threads and settings")
        {
            scene->getSettings()->setThreads(1);
            view.frames(2);
            scene->getSettings()->setIntegrator(RayTraceSettings::WHITTED);
            view.frames(2);
        }
        SECTION("paused")
        {
            scene->getDrawable()->setPaused(true);
            view.frames(2);
            scene->getDrawable()->setPaused(false);
            view.frames(2);
        }
        if (scene) CHECK(statistics(*scene).passes == 0);
    }
}

TEST_CASE("background: a view that moves in each frame has new pictures, each of one view", "[gl]")
{
    constexpr int kViews = 15;
    std::vector<osg::ref_ptr<osg::Image>> expected;
    osg::ref_ptr<RayTracedScene> locked = ballScene(RayTraceSettings::FRAME_LOCKED, 1);
    TestViewer exact(kSize, kSize, locked.get());
    for (int i = 0; i < kViews; ++i)
    {
        exact.look(eyeAt(i));
        expected.push_back(exact.frames());
    }

    osg::ref_ptr<RayTracedScene> scene = ballScene(RayTraceSettings::BACKGROUND, 1);
    TestViewer view(kSize, kSize, scene.get());
    int changes = 0, last = -1, frame = 0;
    bool torn = false;
    CHECK(framesUntil(view,
                      [&]
                      {
                          view.look(eyeAt(++frame));
                          const osg::Image& shown = *view.capture->getColorImage();
                          int found = -1;
                          for (int i = 0; i < kViews && found < 0; ++i)
                              if (equal(shown, *expected[std::size_t(i)])) found = i;
                          torn |= found < 0 && !isBlack(shown); // black: no image yet
                          changes += found >= 0 && found != last;
                          last = found;
                          return changes == 30;
                      }));
    CHECK_FALSE(torn);
}

TEST_CASE("background: the presentation changes while it runs, and the image goes on", "[gl]")
{
    osg::ref_ptr<RayTracedScene> locked = ballScene(RayTraceSettings::FRAME_LOCKED, 40);
    TestViewer exact(kSize, kSize, locked.get());
    osg::ref_ptr<RayTracedScene> scene = ballScene(RayTraceSettings::FRAME_LOCKED, 40);
    TestViewer view(kSize, kSize, scene.get());
    int passes = 0;
    for (int i = 0; i < 8; ++i)
    {
        scene->getSettings()->setPresentation(RayTraceSettings::BACKGROUND);
        view.frames(1 + i % 3);
        scene->getSettings()->setPresentation(RayTraceSettings::FRAME_LOCKED);
        const osg::ref_ptr<osg::Image> image = view.frames();
        const int now = statistics(*scene).passes;
        CHECK((now > passes || now == 40));
        passes = now;
        // A frame-locked view presents its newest image.
        while (statistics(*locked).passes < now)
            exact.frames();
        CHECK(equal(*image, *exact.frames(now == 40 ? 1 : 0)));
    }
    // The view moves just before it is frame-locked.
    scene->getSettings()->setPresentation(RayTraceSettings::BACKGROUND);
    view.look(eyeAt(1));
    view.frames(2);
    scene->getSettings()->setPresentation(RayTraceSettings::FRAME_LOCKED);
    view.look(eyeAt(2));
    exact.look(eyeAt(2));
    CHECK(equal(*view.frames(), *exact.frames()));
}

TEST_CASE("background: an edit shows, in its time", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = ballScene(RayTraceSettings::BACKGROUND, 2);
    TestViewer view(kSize, kSize, scene.get());
    const auto isGreen = [&]
    { return pixel(*view.capture->getColorImage(), kSize / 2, kSize / 2).y() > 100.0; };
    REQUIRE(framesUntil(view, isGreen));
    scene->removeChildren(0, scene->getNumChildren());
    CHECK(framesUntil(view, [&] { return !isGreen(); }));
    scene->addChild(sphere(osg::Vec3(), 2.5f, kGreen).get());
    CHECK(framesUntil(view, isGreen));
}

TEST_CASE("background: what cannot be traced is rasterized, until told to try again", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = ballScene(RayTraceSettings::BACKGROUND, 1);
    TestViewer view(kSize, kSize, scene.get());
    view.camera().removeFinalDrawCallback(view.capture.get()); // it would copy all these pixels
    view.camera().setProjectionResizePolicy(osg::Camera::FIXED);
    view.camera().setViewport(0, 0, 20000, 20000); // more pixels than a film holds
    view.viewer.realize();
    CHECK(framesUntil(view, [&] { return !statistics(*scene).ok; }));
    CHECK_FALSE(statistics(*scene).message.empty());

    view.camera().setViewport(0, 0, kSize, kSize);
    view.camera().addFinalDrawCallback(view.capture.get());
    const auto middle = [&] { return pixel(*view.capture->getColorImage(), kSize / 2, kSize / 2); };
    view.frames();
    CHECK(middle().y() > 100.0);
    CHECK_FALSE(statistics(*scene).ok);
    SECTION("dirtyScene")
    {
        scene->dirtyScene();
    }
    SECTION("setEnabled")
    {
        scene->setEnabled(true);
    }
    CHECK(
        framesUntil(view, [&] { return statistics(*scene).ok && statistics(*scene).passes == 1; }));
}

TEST_CASE("background: a viewer that draws on demand goes on drawing", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = ballScene(RayTraceSettings::BACKGROUND, 4);
    TestViewer view(kSize, kSize, scene.get());
    view.viewer.setRunFrameScheme(osgViewer::ViewerBase::ON_DEMAND);
    view.frames();
    CHECK(framesUntil(view,
                      [&]
                      {
                          REQUIRE(view.viewer.checkNeedToDoFrame());
                          return statistics(*scene).passes == 4;
                      }));
}

TEST_CASE("background: two windows and draw threads of their own", "[gl]")
{
    const auto model = GENERATE(osgViewer::ViewerBase::DrawThreadPerContext,
                                osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext);
    osg::ref_ptr<RayTracedScene> scene = ballScene(RayTraceSettings::BACKGROUND, 3);
    osgViewer::Viewer viewer;
    viewer.getCamera()->setProjectionMatrixAsPerspective(40.0, 1.0, 1.0, 100.0);
    osg::ref_ptr<FrameCapture> captures[] = {new FrameCapture, new FrameCapture};
    for (const osg::ref_ptr<FrameCapture>& capture : captures)
    {
        osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setGraphicsContext(createOSMesaContext(kSize, kSize).get());
        camera->setViewport(0, 0, kSize, kSize);
        camera->addFinalDrawCallback(capture.get());
        viewer.addSlave(camera.get());
    }
    viewer.setThreadingModel(model);
    viewer.setSceneData(scene.get());
    viewer.realize();
    for (int i = 0; i < 60; ++i)
    {
        viewer.getCamera()->setViewMatrixAsLookAt(eyeAt(i), osg::Vec3d(), osg::Vec3d(0, 1, 0));
        if (i % 20 == 10) scene->getSettings()->setPresentation(RayTraceSettings::FRAME_LOCKED);
        if (i % 20 == 15) scene->getSettings()->setPresentation(RayTraceSettings::BACKGROUND);
        if (i % 7 == 0) scene->getDrawable()->getColorImage();
        viewer.frame();
    }
    bool shown = false;
    for (int i = 0; i < 20000 && !shown; ++i)
    {
        viewer.frame();
        viewer.stopThreading();
        shown = true;
        for (const osg::ref_ptr<FrameCapture>& capture : captures)
            shown &= pixel(*capture->getColorImage(), kSize / 2, kSize / 2).y() > 100.0;
        viewer.startThreading();
    }
    viewer.stopThreading();
    CHECK(shown);
    CHECK(statistics(*scene).ok);
}

/// This test runs alone: the process ends with code 0 while the worker traces and the viewer still
/// exists.
TEST_CASE("background: exit() from a host that closes nothing", "[.][background-exit]")
{
    static const osg::ref_ptr<RayTracedScene> scene = endlessScene(); // destroyed after main
    static TestViewer* const view = new TestViewer(kSize, kSize, scene.get());
    view->frames(3);
    std::exit(statistics(*scene).passes);
}
