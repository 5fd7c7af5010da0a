// RayIntersectorTest.cpp - picks in small graphs as osgUtil does, or as RayIntersector says. Layer:
// tests. SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/api/Picks.h"

#include <osgRayTrace/AreaLight>

#include <osg/AlphaFunc>
#include <osg/AutoTransform>
#include <osg/Billboard>
#include <osg/Camera>
#include <osg/ClipNode>
#include <osg/CullFace>
#include <osg/Geode>
#include <osg/Geometry>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/PolygonOffset>
#include <osg/ShapeDrawable>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

#include <cmath>
#include <random>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

constexpr auto kAll = osgUtil::Intersector::NO_LIMIT;

/// Vertices of a wavy carpet of 8 x 8 cells in the square [-1,1]^2 at height z, row by row.
osg::ref_ptr<osg::Vec3Array> carpetVertices(float z)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (int y = 0; y <= 8; ++y)
        for (int x = 0; x <= 8; ++x)
            vertices->push_back(
                {x * 0.25f - 1.0f, y * 0.25f - 1.0f, z + 0.1f * std::sin(float(x * y))});
    return vertices;
}

/// The carpet's cells as triangles, with degenerate ones and lines between.
osg::ref_ptr<osg::Geometry> carpet(float z)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(carpetVertices(z));
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (GLushort y = 0; y < 4; ++y)
        for (GLushort x = 0; x < 8; ++x)
        {
            const GLushort i = 9 * y + x;
            for (const int corner : {0, 1, 9, 9, 1, 10, 0, 0, 1})
                triangles->push_back(GLushort(i + corner));
        }
    geometry->addPrimitiveSet(triangles);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_LINE_STRIP, 0, 20));
    for (GLuint y = 4; y < 8; ++y)
    {
        osg::ref_ptr<osg::DrawElementsUInt> strip = new osg::DrawElementsUInt(GL_TRIANGLE_STRIP);
        for (GLuint x = 0; x <= 8; ++x)
        {
            strip->push_back(9 * y + x);
            strip->push_back(9 * (y + 1) + x);
        }
        geometry->addPrimitiveSet(strip);
    }
    geometry->setName("carpet");
    return geometry;
}

/// Flat quads, a quad strip and a fan, side by side, with one colour a primitive set.
osg::ref_ptr<osg::Geometry> tiles(float z)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> v = new osg::Vec3Array;
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 5; ++x)
            v->push_back({x * 0.5f - 1.0f, y * 1.0f - 1.0f, z});
    geometry->setVertexArray(v);
    osg::ref_ptr<osg::DrawElementsUByte> quads = new osg::DrawElementsUByte(GL_QUADS);
    for (const int i : {0, 1, 6, 5, 1, 2, 7, 6})
        quads->push_back(GLubyte(i));
    geometry->addPrimitiveSet(quads);
    osg::ref_ptr<osg::DrawElementsUByte> strip = new osg::DrawElementsUByte(GL_QUAD_STRIP);
    for (const int i : {2, 7, 3, 8, 4, 9})
        strip->push_back(GLubyte(i));
    geometry->addPrimitiveSet(strip);
    osg::ref_ptr<osg::DrawElementsUByte> fan = new osg::DrawElementsUByte(GL_POLYGON);
    for (const int i : {5, 9, 14, 10})
        fan->push_back(GLubyte(i));
    geometry->addPrimitiveSet(fan);
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    for (int i = 0; i < 3; ++i)
        colors->push_back({0.2f * i, 1.0f, 1.0f, 1.0f});
    geometry->setColorArray(colors, osg::Array::BIND_PER_PRIMITIVE_SET);
    geometry->setName("tiles");
    return geometry;
}

osg::ref_ptr<osg::MatrixTransform> placed(const osg::Matrixd& matrix, osg::Node* child)
{
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
    transform->addChild(child);
    return transform;
}

osg::ref_ptr<RayTracedScene> sceneOf(osg::Node* child)
{
    osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    scene->addChild(child);
    return scene;
}

/// Both carpets in several places, shared and mirrored, and tiles in a geode.
osg::ref_ptr<osg::Group> manyThings()
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osg::Geometry> shared = carpet(0.0f);
    root->addChild(placed(osg::Matrixd::translate(0, 0, -1), shared));
    root->addChild(
        placed(osg::Matrixd::rotate(0.7, osg::Vec3d(1, 2, 3)) * osg::Matrixd::translate(0, 0, 1),
               placed(osg::Matrixd::scale(0.5, 1.5, 1.0), shared)));
    root->addChild(placed(osg::Matrixd::scale(-1.0, 1.0, 1.0), carpet(0.3f)));
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(tiles(0.6f));
    root->addChild(geode);
    root->addChild(carpet(-0.4f));
    return root;
}

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

/// The place that the weights and vertices of a hit say it is at.
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

Picks down(osg::Node& root, double x = 0.1, double y = 0.2)
{
    return picksByRay(root, {{x, y, 5.0}, {x, y, -5.0}}, kAll);
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

TEST_CASE("masks of the visitor and limits of the intersector count")
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osg::Geometry> upper = carpet(1.0f), lower = carpet(-1.0f);
    upper->setNodeMask(1);
    lower->setNodeMask(2);
    root->addChild(upper);
    root->addChild(lower);
    const osg::ref_ptr<osg::Geode> ball = new osg::Geode;
    ball->addDrawable(new osg::ShapeDrawable(new osg::Sphere({0, 0, -3}, 1.0f)));
    root->addChild(ball);
    const osg::ref_ptr<RayTracedScene> scene = sceneOf(root);
    const auto pick = [&](osg::Node::NodeMask mask, osgUtil::Intersector::IntersectionLimit limit)
    {
        const osg::ref_ptr<RayIntersector> ray =
            new RayIntersector(osg::Vec3d(0.1, 0.2, 5), osg::Vec3d(0.1, 0.2, -5));
        ray->setIntersectionLimit(limit);
        osgUtil::IntersectionVisitor visitor(ray);
        visitor.setTraversalMask(mask);
        scene->accept(visitor);
        return Picks(ray->getIntersections().begin(), ray->getIntersections().end());
    };
    const Picks all = pick(~0u, kAll);
    REQUIRE(all.size() == 4);
    CHECK(all[0].drawable == upper);
    const Picks masked = pick(2, kAll);
    REQUIRE(masked.size() == 3);
    CHECK(masked[0].drawable == lower);
    CHECK(pick(2, osgUtil::Intersector::LIMIT_NEAREST).front().drawable == lower);
    CHECK(pick(~0u, osgUtil::Intersector::LIMIT_ONE).size() == 1);
    CHECK(pick(~0u, osgUtil::Intersector::LIMIT_ONE_PER_DRAWABLE).size() == 3);
}

TEST_CASE("visible only: culled faces and refused texels are not hit")
{
    const osg::ref_ptr<osg::Geometry> culled = tiles(1.0f);
    culled->getOrCreateStateSet()->setAttributeAndModes(new osg::CullFace(osg::CullFace::BACK));
    const osg::ref_ptr<osg::Geometry> refused = carpet(0.0f);
    const osg::ref_ptr<osg::Material> glassy = new osg::Material;
    glassy->setAlpha(osg::Material::FRONT_AND_BACK, 0.25f);
    refused->getOrCreateStateSet()->setAttributeAndModes(glassy);
    refused->getOrCreateStateSet()->setAttributeAndModes(
        new osg::AlphaFunc(osg::AlphaFunc::GREATER, 0.5f));
    const osg::ref_ptr<osg::Geometry> blended = carpet(-1.0f);
    blended->getOrCreateStateSet()->setAttributeAndModes(glassy);
    blended->getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    for (osg::Geometry* geometry : {culled.get(), refused.get(), blended.get()})
        root->addChild(geometry);
    const osg::ref_ptr<RayTracedScene> scene = sceneOf(root);
    const auto pick = [&](double from, bool visibleOnly)
    {
        const osg::ref_ptr<RayIntersector> ray =
            new RayIntersector(osg::Vec3d(-0.3, -0.3, from), osg::Vec3d(-0.3, -0.3, -from));
        ray->setIntersectionLimit(kAll);
        ray->setVisibleOnly(visibleOnly);
        return picksOf(*scene, *ray);
    };
    CHECK(pick(5.0, false).size() == 3);
    CHECK(pick(-5.0, false).size() == 3);
    const Picks above = pick(5.0, true), below = pick(-5.0, true);
    REQUIRE(above.size() == 2);
    CHECK(above[0].drawable == culled);
    CHECK(above[1].drawable == blended);
    REQUIRE(below.size() == 1);
    CHECK(below[0].drawable == blended);
}

TEST_CASE("lamps are hit, clip planes count, raised faces are where they are in the graph")
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<AreaLight> lamp = new AreaLight;
    lamp->setCorner({-1, -1, 4});
    lamp->setEdgeU({2, 0, 0});
    lamp->setEdgeV({0, 2, 0});
    root->addChild(lamp);
    const osg::ref_ptr<osg::ClipNode> clipped = new osg::ClipNode;
    clipped->addClipPlane(new osg::ClipPlane(0, 1.0, 0.0, 0.0, -0.1)); // x > 0.1 is kept
    clipped->addChild(carpet(2.0f));
    root->addChild(clipped);
    const osg::ref_ptr<osg::Geometry> raised = carpet(0.0f);
    raised->getOrCreateStateSet()->setAttributeAndModes(new osg::PolygonOffset(-1.0f, -1.0f));
    root->addChild(raised);
    const osg::ref_ptr<RayTracedScene> scene = sceneOf(root);

    const Picks cut = down(*scene, -0.3, 0.2);
    REQUIRE(cut.size() == 2);
    CHECK(cut[0].nodePath[2] == lamp);
    CHECK(cut[1].drawable == raised);
    const Picks theirs = picksOfOsg(*scene, {{0.14, 0.2, 5}, {0.14, 0.2, -5}});
    const Picks kept = down(*scene, 0.14, 0.2); // in a triangle that the plane cuts
    REQUIRE(kept.size() == 3);
    REQUIRE(theirs.size() == 3);
    for (int i = 0; i < 3; ++i)
    {
        CHECK(isSamePrimitive(kept[i], theirs[i]));
        CHECK(kept[i].ratio == Approx(theirs[i].ratio).margin(1e-6));
        CHECK((kept[i].localIntersectionNormal - theirs[i].localIntersectionNormal).length() <
              1e-4f);
    }
}

TEST_CASE("a pick before any frame sees the graph as it is")
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osg::Geometry> geometry = carpet(0.0f);
    const osg::ref_ptr<osg::MatrixTransform> transform = placed(osg::Matrixd(), geometry);
    root->addChild(transform);
    const osg::ref_ptr<RayTracedScene> scene = sceneOf(root);
    REQUIRE(down(*scene).size() == 1);
    const double before = down(*scene).front().ratio;

    transform->setMatrix(osg::Matrixd::translate(0, 0, 2));
    REQUIRE(down(*scene).size() == 1);
    CHECK(down(*scene).front().ratio == Approx(before - 0.2));
    auto& vertices = static_cast<osg::Vec3Array&>(*geometry->getVertexArray());
    for (osg::Vec3& v : vertices)
        v.z() += 1.0f;
    vertices.dirty();
    geometry->dirtyBound();
    REQUIRE(down(*scene).size() == 1);
    CHECK(down(*scene).front().ratio == Approx(before - 0.3));
    CHECK(checkLines(*scene, 50) > 20);
    root->addChild(tiles(-2.0f));
    CHECK(down(*scene).size() == 2);
    root->removeChild(transform);
    CHECK(down(*scene).size() == 1);
    root->removeChildren(0, 1);
    CHECK(down(*scene).empty());
}

TEST_CASE("a pick in a viewed scene is that of the last frame")
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::MatrixTransform> transform = placed(osg::Matrixd(), carpet(0.0f));
    root->addChild(transform);
    const osg::ref_ptr<RayTracedScene> scene = sceneOf(root);
    const auto frame = [&scene](unsigned int number)
    {
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setFrameNumber(number);
        osgUtil::CullVisitor cull;
        cull.setFrameStamp(stamp);
        cull.setStateGraph(new osgUtil::StateGraph);
        cull.setRenderStage(new osgUtil::RenderStage);
        cull.pushViewport(new osg::Viewport(0, 0, 64, 64));
        cull.pushProjectionMatrix(new osg::RefMatrix(osg::Matrixd::perspective(30, 1, 1, 100)));
        cull.pushModelViewMatrix(new osg::RefMatrix(osg::Matrixd::translate(0, 0, -20)),
                                 osg::Transform::ABSOLUTE_RF);
        scene->accept(cull);
    };
    frame(1);
    const Picks before = down(*scene);
    REQUIRE(before.size() == 1);
    transform->setMatrix(osg::Matrixd::translate(0, 0, 2));
    const Picks stale = down(*scene);
    REQUIRE(stale.size() == 1);
    CHECK(stale.front().ratio == Approx(before.front().ratio).margin(1e-6));
    frame(2);
    REQUIRE(down(*scene).size() == 1);
    CHECK(down(*scene).front().ratio == Approx(before.front().ratio - 0.2));

    root->removeChildren(0, 1);
    transform = nullptr;
    CHECK(down(*scene).size() <= 1); // it may still be there, and is whole
    frame(3);
    CHECK(down(*scene).empty());
}

TEST_CASE("segments end where they end, and disabled scenes are osgUtil's")
{
    const osg::ref_ptr<osg::Geometry> flat = tiles(1.0f);
    const osg::ref_ptr<RayTracedScene> scene = sceneOf(flat);
    const auto count = [&](double from, double to) {
        return picksByRay(*scene, {{0.1, -0.3, from}, {0.1, -0.3, to}}).size();
    };
    CHECK(count(5.0, 1.0) == 1);
    CHECK(count(5.0, 1.0 + 1e-9) == 0);
    CHECK(count(1.0, -5.0) == 1);
    CHECK(count(1.0 - 1e-9, -5.0) == 0);
    CHECK(count(1e12, -1e12) == 1);
    CHECK(count(2.0, 2.0) == 0);
    CHECK(count(std::nan(""), 0.0) == 0);

    scene->setEnabled(false);
    CHECK(picksByRay(*scene, {{0.1, -0.3, 5.0}, {0.1, -0.3, -5.0}}).size() == 1);
    const osg::ref_ptr<RayTracedScene> nothing = new RayTracedScene;
    CHECK(down(*nothing).empty());
    CHECK(down(*flat).size() >= 1); // there is no traced scene: osgUtil's
}
