// CaveViewTest.cpp - walls of a CAVE: the eyes of a head, and their frusta. Layer: tests.
// SPDX-License-Identifier: MIT
#include "apps/cave/CaveView.h"
#include "tests/Catch.h"

#include <cmath>
#include <random>
#include <vector>

using namespace osgRayTrace::app;

namespace
{

osg::Vec3d clipOf(const CaveView& view, const osg::Vec3d& world)
{
    return world * view.view * view.projection;
}

} // namespace

TEST_CASE("the frustum of a wall is that of its edges, seen from the eye")
{
    CaveSetup setup;
    CaveWall wall; // 3 m by 2 m, 1.5 m in front
    wall.screenWidth = 3000.0;
    wall.screenHeight = 2000.0;
    wall.screen.position = {0, 1500, 0};
    setup.nearPlane = 10.0;
    const CavePose head{
        {200, -300, 100}, 30.0, 10.0, 5.0}; // the middle eye does not depend on angles
    const auto view = caveView(setup, wall, CaveEye::Centre, head.matrix());
    REQUIRE(view);
    double left, right, bottom, top, zNear, zFar;
    REQUIRE(view->projection.getFrustum(left, right, bottom, top, zNear, zFar));
    CHECK(left == Approx(10.0 * (-1500.0 - 200.0) / 1800.0));
    CHECK(right == Approx(10.0 * (1500.0 - 200.0) / 1800.0));
    CHECK(bottom == Approx(10.0 * (-1000.0 - 100.0) / 1800.0));
    CHECK(top == Approx(10.0 * (1000.0 - 100.0) / 1800.0));
    CHECK(zNear == Approx(10.0));
    CHECK(zFar == Approx(1e7).epsilon(1e-4));

    CHECK_FALSE(caveView(setup, wall, CaveEye::Centre, osg::Matrixd::translate(0, 1500, 0)));
    CHECK_FALSE(caveView(setup, wall, CaveEye::Centre, osg::Matrixd::translate(0, 1600, 0)));
}

TEST_CASE("corners of any wall are corners of its picture, from any place before it")
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    int views = 0;
    for (int i = 0; i < 200; ++i)
    {
        CaveSetup setup;
        CaveWall wall;
        wall.screenWidth = 1000.0 + 900.0 * unit(random);
        wall.screenHeight = 1000.0 + 900.0 * unit(random);
        wall.screen = {{2000 * unit(random), 2000 * unit(random), 2000 * unit(random)},
                       180 * unit(random),
                       80 * unit(random),
                       180 * unit(random)};
        wall.followsHead = i % 2 == 1;
        const CaveEye eye =
            std::vector<CaveEye>{CaveEye::Centre, CaveEye::Left, CaveEye::Right}[i % 3];
        const CavePose place{{unit(random), unit(random), unit(random)},
                             180 * unit(random),
                             60 * unit(random),
                             60 * unit(random)};
        // The screen faces -y of its own frame: the head is put there.
        osg::Matrixd head = place.matrix();
        const osg::Matrixd world = wall.screen.matrix();
        if (!wall.followsHead)
            head.setTrans(
                osg::Vec3d(700 * unit(random), -500 + 300 * unit(random), 700 * unit(random)) *
                world);
        const osg::Matrixd worldFromScreen = wall.followsHead ? world * head : world;
        const auto view = caveView(setup, wall, eye, head);
        const osg::Vec3d at = eyePosition(setup, wall, eye, head);
        const double before = -(at * osg::Matrixd::inverse(worldFromScreen)).y();
        REQUIRE(view.has_value() == (before > 1e-6 * (wall.screenWidth + wall.screenHeight)));
        if (!view) continue;
        ++views;
        for (const double x : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0})
            {
                const osg::Vec3d corner =
                    osg::Vec3d(0.5 * x * wall.screenWidth, 0.0, 0.5 * z * wall.screenHeight) *
                    worldFromScreen;
                const osg::Vec3d clip = clipOf(*view, corner);
                CHECK(std::fabs(clip.x() - x) < 1e-9);
                CHECK(std::fabs(clip.y() - z) < 1e-9);
            }
        CHECK((osg::Matrixd::inverse(view->view).getTrans() - at).length() < 1e-8);
    }
    CHECK(views > 120); // a wall that follows the head may lie behind it
}

TEST_CASE("angles are heading about z, pitch about x, roll about y")
{
    const auto axis = [](double h, double p, double r, const osg::Vec3d& v) {
        return osg::Matrixd::transform3x3(v, CavePose{{}, h, p, r}.matrix());
    };
    const osg::Vec3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    CHECK((axis(90, 0, 0, y) + x).length() < 1e-12); // to the left
    CHECK((axis(0, 90, 0, y) - z).length() < 1e-12); // up
    CHECK((axis(0, 0, 90, z) - x).length() < 1e-12); // to the right
    CHECK((axis(90, 90, 0, y) - z).length() < 1e-12);
    CHECK((axis(90, 0, 90, z) - y).length() < 1e-12);
}

TEST_CASE("eyes are beside each other across the head, or across the way to the wall")
{
    CaveSetup setup;
    CaveWall wall;
    wall.screen.position = {-1500, 0, 0};
    wall.screen.h = 90.0;
    const osg::Matrixd head = CavePose{{10, 20, 30}, 0.0, 0.0, 0.0}.matrix();
    const auto at = [&](CaveEye eye)
    { return eyePosition(setup, wall, eye, head) - osg::Vec3d(10, 20, 30); };
    CHECK((at(CaveEye::Left) - osg::Vec3d(-32, 0, 0)).length() < 1e-9);
    CHECK((at(CaveEye::Right) - osg::Vec3d(32, 0, 0)).length() < 1e-9);
    CHECK(at(CaveEye::Centre).length() < 1e-9);
    wall.swapsEyes = true;
    CHECK((at(CaveEye::Left) - osg::Vec3d(32, 0, 0)).length() < 1e-9);
    wall.swapsEyes = false;
    setup.omniStereo = true; // the wall is on the left: its right is to the front
    CHECK(at(CaveEye::Right).y() == Approx(32.0).epsilon(1e-3));
    wall.fixedViewer = true;
    wall.viewer = {1, 2, 3};
    CHECK((eyePosition(setup, wall, CaveEye::Left, head) - osg::Vec3d(1, 2, 3)).length() < 1e-9);
}
