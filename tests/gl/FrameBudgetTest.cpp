// FrameBudgetTest.cpp - frame budgets in a viewer: which views share one, and what the pictures
// are. Layer: tests.
// SPDX-License-Identifier: MIT
#include "TestViewer.h"
#include "tests/Catch.h"

#include <osg/ValueObject>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

constexpr int kSize = 128;
constexpr float kEndless = 60000.0f; // [ms] no frame takes so long
constexpr float kNothing = 1e-3f;    // [ms] no frame is so fast

const osg::Vec4 kGreen(0.0f, 1.0f, 0.0f, 1.0f);

int passes(const RayTracedScene& scene)
{
    return scene.getDrawable()->getStatistics().passes;
}

int divider(const RayTracedScene& scene)
{
    return scene.getDrawable()->getStatistics().resolutionDivider;
}

} // namespace

TEST_CASE("frame budget: a frame with time for all passes makes them all", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = tracedScene(unlitSquare(1.0f, kGreen).get());
    scene->getSettings()->setMaxPasses(12);
    scene->getSettings()->setFrameBudget(kEndless);
    TestViewer view(kSize, kSize, scene.get());
    view.frames(2); // in the first frame costs are unknown
    CHECK(passes(*scene) == 12);
    CHECK(divider(*scene) == 1);
    CHECK(scene->getDrawable()->getStatistics().frameSeconds > 0.0);
}

TEST_CASE("frame budget: a camera's own wins, of any type", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = tracedScene(unlitSquare(1.0f, kGreen).get());
    scene->getSettings()->setFrameBudget(kEndless);
    scene->getSettings()->setMaxPasses(50);
    TestViewer view(kSize, kSize, scene.get());
    SECTION("float")
    {
        view.camera().setUserValue("osgRayTrace.frameBudget", 0.0f);
    }
    SECTION("double")
    {
        view.camera().setUserValue("osgRayTrace.frameBudget", 0.0);
    }
    SECTION("int")
    {
        view.camera().setUserValue("osgRayTrace.frameBudget", 0);
    }
    SECTION("no number: as none")
    {
        view.camera().setUserValue("osgRayTrace.frameBudget",
                                   std::numeric_limits<double>::quiet_NaN());
    }
    for (int i = 1; i <= 3; ++i)
    {
        view.frames();
        CHECK(passes(*scene) == i); // by the option passes-per-frame
    }
}

TEST_CASE("frame budget: with no time at all a moving view is coarse and smooth, and at rest "
          "becomes fine",
          "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = tracedScene(sphere(osg::Vec3(), 2.5f, kGreen).get());
    TestViewer exact(kSize, kSize, scene.get());
    const osg::ref_ptr<osg::Image> fine = exact.frames(4);

    osg::ref_ptr<RayTracedScene> budgeted = tracedScene(sphere(osg::Vec3(), 2.5f, kGreen).get());
    budgeted->getSettings()->setFrameBudget(kNothing);
    budgeted->getSettings()->setMaxPasses(4);
    TestViewer view(kSize, kSize, budgeted.get());
    view.look(osg::Vec3d(0.0, 0.3, 10.0));
    view.frames();
    view.look(osg::Vec3d(0.0, 0.0, 10.0));
    const osg::ref_ptr<osg::Image> coarse = view.frames();
    CHECK(divider(*budgeted) > 4);
    CHECK(meanDifference(*coarse, *fine) < 20.0); // the pictures are of one scene
    CHECK(meanDifference(*coarse, *fine) > 0.5);
    int steps =
        0; // in the middle of the sphere neighbours are alike: blocks would differ from theirs
    for (int x = 50; x < 78; ++x)
        steps = std::max(
            steps, std::abs(int(pixel(*coarse, x, 64).g()) - int(pixel(*coarse, x + 1, 64).g())));
    CHECK(steps < 10);
    if (const char* folder = std::getenv("OSGRAYTRACE_PICTURES"))
    {
        osgDB::writeImageFile(*coarse, std::string(folder) + "/budget-coarse.png");
        view.frames(20);
        osgDB::writeImageFile(*view.frames(), std::string(folder) + "/budget-mixed.png");
    }

    // At least one tile is traced in each frame: there are 64 tiles and four passes.
    for (int i = 0; i < 300 && (divider(*budgeted) > 1 || passes(*budgeted) < 4); ++i)
        view.frames();
    CHECK(divider(*budgeted) == 1);
    CHECK(passes(*budgeted) == 4);
    CHECK(equal(*view.frames(), *fine));
}

namespace
{

/// Records what the views of a scene showed when they were last drawn.
struct Shown : osg::Camera::DrawCallback
{
    explicit Shown(const RayTracedScene& traced) : scene(&traced) {}
    void operator()(osg::RenderInfo&) const override
    {
        shownPasses = passes(*scene);
        displayDivider = divider(*scene);
    }
    const RayTracedScene* scene;
    mutable int shownPasses = -1, displayDivider = -1;
};

/// A viewer with a second window, which is smaller.
struct TwoWindows : TestViewer
{
    TwoWindows(RayTracedScene* scene)
        : TestViewer(kSize, kSize, scene), large(new Shown(*scene)), small(new Shown(*scene))
    {
        osg::ref_ptr<osg::Camera> second = new osg::Camera;
        second->setGraphicsContext(createOSMesaContext(kSize / 2, kSize / 2).get());
        second->setViewport(0, 0, kSize / 2, kSize / 2);
        second->setComputeNearFarMode(osg::Camera::DO_NOT_COMPUTE_NEAR_FAR);
        second->addFinalDrawCallback(small.get());
        camera().addFinalDrawCallback(large.get());
        viewer.addSlave(second.get());
    }
    osg::ref_ptr<Shown> large, small;
};

} // namespace

TEST_CASE(
    "equal views: windows of any size make their passes in the same frames, at the same resolution",
    "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = tracedScene(sphere(osg::Vec3(), 2.5f, kGreen).get());
    scene->getSettings()->setFrameBudget(kNothing);
    scene->getSettings()->setMaxPasses(2);
    scene->getSettings()->setEqualViews(true);
    TwoWindows view(scene.get());
    int completed = 0;
    for (int i = 0; i < 540; ++i)
    {
        if (i < 20) view.look(osg::Vec3d(0.0, 0.01 * i, 10.0));
        view.viewer.frame();
        CAPTURE(i);
        REQUIRE(view.large->shownPasses == view.small->shownPasses);
        REQUIRE(view.large->displayDivider == view.small->displayDivider);
        completed += view.large->displayDivider == 1;
    }
    CHECK(completed > 200);
    CHECK(view.small->shownPasses == 2);
}

TEST_CASE("equal views: what somebody else decides holds for all, but for cameras with a budget of "
          "their own",
          "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = tracedScene(sphere(osg::Vec3(), 2.5f, kGreen).get());
    scene->getSettings()->setFrameBudget(kEndless);
    scene->getSettings()->setEqualViews(true);
    RayTraceDrawable& drawable = *scene->getDrawable();
    CHECK_FALSE(drawable.getAffordableWork());
    TwoWindows view(scene.get());
    FrameWork work;
    work.divider = 2;
    work.passes = 3;
    work.progress = 2 * FrameWork::WHOLE_PASS;
    drawable.setFrameWork(work);
    const bool own = GENERATE(false, true);
    if (own) view.camera().setUserValue("osgRayTrace.frameBudget", 0.0f);
    for (int i = 0; i < 5; ++i)
    {
        view.look(osg::Vec3d(0.0, 0.01 * i, 10.0));
        view.viewer.frame();
        CHECK(view.large->displayDivider == (own ? 1 : 2));
        CHECK(view.large->shownPasses == (own ? 1 : 3));
        CHECK(view.small->displayDivider == 2);
        CHECK(view.small->shownPasses == 3);
    }
    view.viewer.frame();
    for (const int expected : {2, 4})
    {
        view.viewer.frame();
        CHECK(view.small->displayDivider == 1);
        CHECK(view.small->shownPasses == expected);
    }
    const std::optional<FrameWork> affordable = drawable.getAffordableWork();
    REQUIRE(affordable);
    CHECK(affordable->divider == 1);
    CHECK(affordable->passes > 3);
    drawable.setFrameWork(std::nullopt);
    view.look(osg::Vec3d(0.0, 0.1, 10.0));
    view.viewer.frame();
    CHECK(view.small->displayDivider == 1);
    CHECK(view.small->shownPasses > 3);
}
