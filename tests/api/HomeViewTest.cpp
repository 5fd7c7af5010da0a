// HomeViewTest.cpp - tests that the home view is the one osgViewer opens with.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/HomeView.h"
#include "tests/Catch.h"

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>

#include <cmath>

using osgRayTrace::engine::homeView;
using osgRayTrace::engine::HomeView;

namespace
{

constexpr double kViewerFovyDegrees = 29.148431;

/// Returns a quad from corner, 6 wide and 2 high, that faces -y.
osg::ref_ptr<osg::Node> sign(const osg::Vec3& corner)
{
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(osg::createTexturedQuadGeometry(corner, osg::Vec3(6.0f, 0.0f, 0.0f),
                                                       osg::Vec3(0.0f, 0.0f, 2.0f)));
    return geode;
}

double largestDifference(const osg::Matrixd& a, const osg::Matrixd& b)
{
    double largest = 0.0;
    for (int i = 0; i < 16; ++i)
    {
        largest = std::max(largest, std::abs(a.ptr()[i] - b.ptr()[i]));
    }
    return largest;
}

} // namespace

TEST_CASE("home view: the matrices are a real viewer's", "[api][renderer]")
{
    for (const osg::Vec3& corner :
         {osg::Vec3(), osg::Vec3(100.0f, -20.0f, 7.0f), osg::Vec3(-3.0f, 0.0f, -1.0f)})
    {
        const auto scene = sign(corner);
        osgViewer::Viewer viewer;
        const osg::ref_ptr<osgGA::TrackballManipulator> manipulator =
            new osgGA::TrackballManipulator;
        viewer.setCameraManipulator(manipulator);
        viewer.setSceneData(scene);
        manipulator->updateCamera(*viewer.getCamera());

        const HomeView home = homeView(*scene, kViewerFovyDegrees, 16.0 / 9.0);
        CHECK(largestDifference(home.view, viewer.getCamera()->getViewMatrix()) < 1e-6);

        double fovy, aspect, nearDistance, farDistance;
        viewer.getCamera()->getProjectionMatrixAsPerspective(fovy, aspect, nearDistance,
                                                             farDistance);
        CHECK(fovy == Approx(kViewerFovyDegrees).epsilon(1e-6));
        double homeFovy, homeAspect;
        REQUIRE(home.projection.getPerspective(homeFovy, homeAspect, nearDistance, farDistance));
        CHECK(homeFovy == Approx(fovy).epsilon(1e-6));
        CHECK(homeAspect == Approx(16.0 / 9.0));
    }
}

TEST_CASE("home view: near and far planes enclose the scene at any size", "[api][renderer]")
{
    for (const double scale : {1e-6, 1.0, 1e6})
    {
        INFO(scale);
        const osg::ref_ptr<osg::MatrixTransform> scene =
            new osg::MatrixTransform(osg::Matrix::scale(scale, scale, scale));
        scene->addChild(sign(osg::Vec3()));
        const HomeView home = homeView(*scene, kViewerFovyDegrees, 1.0);
        for (const osg::Vec3d& point : {osg::Vec3d(), osg::Vec3d(6.0, 0.0, 2.0)})
        {
            const osg::Vec3d inView = point * scale * home.view;
            const double clipZ = (inView * home.projection).z();
            CHECK(clipZ > -1.0);
            CHECK(clipZ < 1.0);
        }
    }
}

TEST_CASE("home view: near and far planes enclose what is larger than its stored bound",
          "[api][renderer]")
{
    const osg::ref_ptr<osg::Node> scene = sign(osg::Vec3());
    scene->setInitialBound(osg::BoundingSphere(osg::Vec3(3.0f, -5.0f, 1.0f), 0.5f));
    scene->setComputeBoundingSphereCallback(new osg::Node::ComputeBoundingSphereCallback);
    const HomeView home = homeView(*scene, kViewerFovyDegrees, 1.0);
    for (const osg::Vec3d& point : {osg::Vec3d(), osg::Vec3d(6.0, 0.0, 2.0)})
    {
        const osg::Vec3d inView = point * home.view;
        const double clipZ = (inView * home.projection).z();
        CHECK(clipZ > -1.0);
        CHECK(clipZ < 1.0);
    }
}

TEST_CASE("home view: an empty scene has one too", "[api][renderer]")
{
    const osg::ref_ptr<osg::Group> empty = new osg::Group;
    const HomeView home = homeView(*empty, kViewerFovyDegrees, 1.0);
    CHECK(home.view.valid());
    CHECK(home.projection.valid());
    osg::Matrixd inverse;
    CHECK(inverse.invert(home.view));
    CHECK(inverse.invert(home.projection));
}
