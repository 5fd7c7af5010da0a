// RayIntersectorTest.cpp - picks in small graphs as osgUtil does, or as RayIntersector says. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/api/PickScenes.h"

#include <osg/AutoTransform>
#include <osg/Billboard>
#include <osg/Camera>

#include <cmath>
#include <random>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

Line randomLine(std::mt19937& random)
{
    std::uniform_real_distribution<double> side(-1.2, 1.2);
    return {{side(random), side(random), 5.0}, {side(random), side(random), -5.0}};
}

void checkAlike(const Pick& ours, const Pick& theirs)
{
    REQUIRE(ours.nodePath == theirs.nodePath);
    REQUIRE(ours.drawable == theirs.drawable);
    REQUIRE(ours.primitiveIndex == theirs.primitiveIndex);
    REQUIRE(std::fabs(ours.ratio - theirs.ratio) < 1e-7);
    REQUIRE((ours.getLocalIntersectPoint() - theirs.getLocalIntersectPoint()).length() < 1e-6);
    REQUIRE((ours.getWorldIntersectPoint() - theirs.getWorldIntersectPoint()).length() < 1e-6);
    REQUIRE((ours.getLocalIntersectNormal() - theirs.getLocalIntersectNormal()).length() < 1e-5f);
    REQUIRE((ours.getWorldIntersectNormal() - theirs.getWorldIntersectNormal()).length() < 1e-5f);
    REQUIRE(ours.matrix.valid() == theirs.matrix.valid());
    if (ours.matrix)
        for (int i = 0; i < 16; ++i)
            REQUIRE(ours.matrix->ptr()[i] == Approx(theirs.matrix->ptr()[i]).margin(1e-12));
}

/// Returns the point that the weights and vertices of a hit give.
osg::Vec3d weighted(const Pick& pick)
{
    const auto& vertices =
        static_cast<const osg::Vec3Array&>(*pick.drawable->asGeometry()->getVertexArray());
    osg::Vec3d sum;
    for (std::size_t i = 0; i < pick.indexList.size(); ++i)
        sum += osg::Vec3d(vertices.at(pick.indexList[i])) * pick.ratioList.at(i);
    return sum;
}

int checkLines(osg::Node& root, int count)
{
    std::mt19937 random(3);
    int hits = 0;
    for (int i = 0; i < count; ++i)
    {
        const Line line = randomLine(random);
        INFO("line " << i);
        const Picks theirs = picksOfOsg(root, line);
        const Picks ours = picksByRay(root, line, kAll);
        REQUIRE(ours.size() == theirs.size());
        for (std::size_t k = 0; k < ours.size(); ++k)
            checkAlike(ours[k], theirs[k]);
        const Picks nearest = picksByRay(root, line);
        REQUIRE(nearest.size() == (theirs.empty() ? 0 : 1));
        if (!theirs.empty()) checkAlike(nearest.front(), theirs.front());
        hits += static_cast<int>(theirs.size());
    }
    return hits;
}

} // namespace

TEST_CASE("a pick tells all that osgUtil tells, of all hits of a segment")
{
    const osg::ref_ptr<RayTracedScene> scene = sceneOf(manyThings());
    CHECK(checkLines(*scene, 500) > 1000);

    const Picks picks = down(*scene);
    REQUIRE(picks.size() > 2);
    for (const Pick& pick : picks)
        CHECK((weighted(pick) - pick.getLocalIntersectPoint()).length() < 1e-6);
}

TEST_CASE("primitives are counted with those that are not traced")
{
    const osg::ref_ptr<osg::Geometry> geometry = carpet(0.0f);
    const osg::ref_ptr<osg::PrimitiveSet> triangles = geometry->getPrimitiveSet(0);
    geometry->setPrimitiveSetList({triangles}); // every third triangle has no area
    const osg::ref_ptr<RayTracedScene> scene = sceneOf(geometry);
    CHECK(checkLines(*scene, 200) > 30);
}

TEST_CASE("vertices in double are picked, which osgUtil cannot read")
{
    const osg::ref_ptr<osg::Geometry> geometry = tiles(1.0f);
    const auto& floats = static_cast<const osg::Vec3Array&>(*geometry->getVertexArray());
    const osg::ref_ptr<osg::Vec3dArray> vertices =
        new osg::Vec3dArray(floats.begin(), floats.end());
    geometry->setVertexArray(vertices);
    const osg::ref_ptr<RayTracedScene> scene = sceneOf(geometry);
    const Line line{{-0.3, -0.3, 5.0}, {-0.3, -0.3, -5.0}};
    const Picks picks = picksByRay(*scene, line);
    REQUIRE(picks.size() == 1);
    CHECK(picks.front().ratio == Approx(0.4).epsilon(1e-12));
    CHECK(picks.front().primitiveIndex == 1);
    CHECK((picks.front().localIntersectionNormal - osg::Vec3(0, 0, 1)).length() < 1e-6f);
}

TEST_CASE("a pick is right far from the origin and below transforms above the scene")
{
    const osg::Matrixd far = osg::Matrixd::rotate(1.0, osg::Vec3d(0.3, -1, 2)) *
                             osg::Matrixd::translate(6.4e6, -3e5, 1e6);
    const osg::ref_ptr<osg::MatrixTransform> below = placed(far, manyThings());
    const osg::ref_ptr<osg::Group> inside = sceneOf(below);
    const osg::ref_ptr<osg::Group> outside = placed(far, sceneOf(manyThings()));
    std::mt19937 random(5);
    for (int i = 0; i < 200; ++i)
    {
        const Line line = randomLine(random);
        for (osg::Group* root : {inside.get(), outside.get()})
        {
            const Line there{line.start * far, line.end * far};
            const Picks theirs = picksOfOsg(*root, there), ours = picksByRay(*root, there);
            INFO("line " << i << ": " << describe(ours) << ", not " << describe(theirs));
            REQUIRE(relation(ours, theirs, 1e-6) != Relation::Other);
        }
    }
}

TEST_CASE("all coordinate frames pick alike")
{
    const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setViewport(0, 0, 400, 300);
    camera->setViewMatrixAsLookAt({3, -4, 6}, {}, {0, 0, 1});
    camera->setProjectionMatrixAsPerspective(30.0, 4.0 / 3.0, 1.0, 100.0);
    camera->addChild(sceneOf(manyThings()));
    const osg::Matrixd clipFromWindow =
        osg::Matrixd::inverse(camera->getViewport()->computeWindowMatrix());
    const osg::Matrixd viewFromClip = osg::Matrixd::inverse(camera->getProjectionMatrix());
    const osg::Matrixd worldFromView = osg::Matrixd::inverse(camera->getViewMatrix());
    int hits = 0;
    for (double x = 5.5; x < 400.0; x += 23.0)
        for (double y = 5.5; y < 300.0; y += 23.0)
        {
            const osg::ref_ptr<Segment> theirs = new Segment(osgUtil::Intersector::WINDOW, x, y);
            const Picks expected = picksOf(*camera, *theirs);
            Line line{theirs->getStart(), theirs->getEnd()};
            const auto check = [&](osgUtil::Intersector::CoordinateFrame frame)
            {
                const osg::ref_ptr<RayIntersector> ray =
                    new RayIntersector(frame, line.start, line.end);
                const Picks picks = picksOf(*camera, *ray);
                INFO("frame " << frame << " at " << x << ", " << y);
                REQUIRE(picks.size() == (expected.empty() ? 0 : 1));
                if (picks.empty()) return;
                REQUIRE(isSamePrimitive(picks.front(), expected.front()));
                REQUIRE((picks.front().getWorldIntersectPoint() -
                         expected.front().getWorldIntersectPoint())
                            .length() < 1e-5);
                ++hits;
            };
            check(osgUtil::Intersector::WINDOW);
            line = {line.start * clipFromWindow, line.end * clipFromWindow};
            check(osgUtil::Intersector::PROJECTION);
            line = {line.start * viewFromClip, line.end * viewFromClip};
            check(osgUtil::Intersector::VIEW);
            line = {line.start * worldFromView, line.end * worldFromView};
            check(osgUtil::Intersector::MODEL);
        }
    CHECK(hits > 100);
}

TEST_CASE("what is not ray traced is picked as osgUtil does")
{
    const osg::ref_ptr<osg::Group> root = manyThings();
    const osg::ref_ptr<osg::Group> hinted =
        placed(osg::Matrixd::translate(0.3, 0.1, 2.0), carpet(0.0f));
    RayTracedScene::setHint(hinted, RayTracedScene::RASTERIZE);
    root->addChild(placed(osg::Matrixd::scale(0.7, 0.7, 0.7), hinted));
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    const osg::ref_ptr<osg::Geometry> hintedTiles = tiles(3.0f);
    RayTracedScene::setHint(hintedTiles, RayTracedScene::RASTERIZE);
    geode->addDrawable(hintedTiles);
    geode->addDrawable(carpet(3.3f));
    root->addChild(geode);
    const osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard;
    billboard->addDrawable(tiles(-2.0f), osg::Vec3(0.0f, 0.0f, 0.5f));
    root->addChild(billboard);
    const osg::ref_ptr<osg::AutoTransform> turning = new osg::AutoTransform;
    turning->setPosition({0.0, 0.2, -2.0});
    turning->addChild(carpet(0.0f));
    turning->addChild(tiles(0.5f));
    root->addChild(turning);
    const osg::ref_ptr<RayTracedScene> scene = sceneOf(root);
    CHECK(checkLines(*scene, 300) > 1500);
}

TEST_CASE("pictures in a camera of their own are picked in its frame")
{
    const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setViewport(0, 0, 200, 200);
    camera->setViewMatrixAsLookAt({0, 0, 20}, {}, {0, 1, 0});
    camera->setProjectionMatrixAsPerspective(30.0, 1.0, 1.0, 100.0);
    const osg::ref_ptr<osg::Group> root = manyThings();
    const osg::ref_ptr<osg::Camera> display = new osg::Camera;
    display->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    display->setRenderOrder(osg::Camera::POST_RENDER);
    display->setProjectionMatrixAsOrtho2D(0, 200, 0, 200);
    display->addChild(
        placed(osg::Matrixd::scale(20, 20, 0.1) * osg::Matrixd::translate(30, 30, 0), tiles(0.0f)));
    root->addChild(display);
    camera->addChild(sceneOf(root));
    for (const double x : {25.3, 104.2, 190.0})
    {
        const osg::ref_ptr<Segment> theirs = new Segment(osgUtil::Intersector::WINDOW, x, x);
        const osg::ref_ptr<RayIntersector> ours =
            new RayIntersector(osgUtil::Intersector::WINDOW, x, x);
        const Picks expected = picksOf(*camera, *theirs), picks = picksOf(*camera, *ours);
        REQUIRE(expected.empty() == (x == 190.0));
        REQUIRE(picks.empty() == expected.empty());
        if (!picks.empty()) CHECK(isSamePrimitive(picks.front(), expected.front()));
    }
}
