// PickRulesTest.cpp - what RayIntersector hits, what it ignores, and when. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/api/PickScenes.h"

#include <osgRayTrace/AreaLight>

#include <osg/AlphaFunc>
#include <osg/ClipNode>
#include <osg/CullFace>
#include <osg/Material>
#include <osg/PolygonOffset>
#include <osg/ShapeDrawable>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

#include <cmath>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

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

TEST_CASE("a plane that makes as many triangles as it takes leaves the numbers of the others")
{
    const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (const float left : {-1.0f, 2.0f, -4.0f}) // the carpet is cut, whole, removed
        for (const osg::Vec3& corner :
             {osg::Vec3(0, 0, 0), osg::Vec3(2, -1, 0), osg::Vec3(2, 1, 0)})
            vertices->push_back(corner + osg::Vec3(left, 0, 0));
    geometry->setVertexArray(vertices);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 9));
    const osg::ref_ptr<osg::ClipNode> clipped = new osg::ClipNode;
    clipped->addClipPlane(new osg::ClipPlane(0, 1.0, 0.0, 0.0, 0.0)); // x > 0 is kept
    clipped->addChild(geometry);
    const osg::ref_ptr<RayTracedScene> scene = sceneOf(clipped);
    const Picks whole = down(*scene, 3.5, 0.1);
    REQUIRE(whole.size() == 1);
    CHECK(whole[0].primitiveIndex == 1);
    REQUIRE(whole[0].indexList.size() == 3);
    CHECK(whole[0].indexList[0] == 3);
    CHECK(down(*scene, -3.0, 0.1).empty());
    const Picks cut = down(*scene, 0.7, 0.1);
    REQUIRE(cut.size() == 1);
    CHECK(cut[0].primitiveIndex == 0);
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
        const osg::ref_ptr<osgUtil::CullVisitor> cull = new osgUtil::CullVisitor;
        cull->setFrameStamp(stamp);
        cull->setStateGraph(new osgUtil::StateGraph);
        cull->setRenderStage(new osgUtil::RenderStage);
        cull->pushViewport(new osg::Viewport(0, 0, 64, 64));
        cull->pushProjectionMatrix(new osg::RefMatrix(osg::Matrixd::perspective(30, 1, 1, 100)));
        cull->pushModelViewMatrix(new osg::RefMatrix(osg::Matrixd::translate(0, 0, -20)),
                                  osg::Transform::ABSOLUTE_RF);
        scene->accept(*cull);
    };
    frame(1);
    const Picks before = down(*scene);
    REQUIRE(before.size() == 1);
    transform->setMatrix(osg::Matrixd::translate(0, 0, 0.5));
    const Picks stale = down(*scene);
    REQUIRE(stale.size() == 1);
    CHECK(stale.front().ratio == Approx(before.front().ratio).margin(1e-6));
    frame(2);
    REQUIRE(down(*scene).size() == 1);
    CHECK(down(*scene).front().ratio == Approx(before.front().ratio - 0.05));

    root->removeChildren(0, 1);
    transform = nullptr;
    CHECK(down(*scene).size() <= 1); // the object may still be there, and is whole then
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
    CHECK(down(*flat).size() >= 1); // without a traced scene osgUtil picks
}
