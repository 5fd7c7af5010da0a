// LiveRestTest.cpp - what changes beside much that rests is redone alone. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osg/Billboard>
#include <osg/CullFace>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/PolygonOffset>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

/// Returns a floor with more vertices than a static BVH that is built in negligible time.
osg::ref_ptr<osg::Geometry> newFloor()
{
    constexpr unsigned int kCells = 190;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (unsigned int j = 0; j <= kCells; ++j)
        for (unsigned int i = 0; i <= kCells; ++i)
            vertices->push_back(osg::Vec3(0.05f * float(i) - 3.0f, 0.05f * float(j) - 3.0f, -0.3f));
    osg::ref_ptr<osg::DrawElementsUInt> indices = new osg::DrawElementsUInt(GL_QUADS);
    for (unsigned int j = 0; j < kCells; ++j)
        for (unsigned int i = 0; i < kCells; ++i)
        {
            const GLuint a = j * (kCells + 1) + i, c = a + kCells + 1;
            for (const GLuint index : {a, a + 1, c + 1, c})
                indices->push_back(index);
        }
    osg::ref_ptr<osg::Geometry> floor = new osg::Geometry;
    floor->setVertexArray(vertices);
    floor->addPrimitiveSet(indices);
    return floor;
}

} // namespace

TEST_CASE("at rest: raised faces leave a static BVH that is given up", "[bridge]")
{
    LiveGraph graph;
    graph.root->addChild(newFloor());
    for (const int raised : {4, 5})
        graph.objects[std::size_t(raised)]->getOrCreateStateSet()->setAttributeAndModes(
            new osg::PolygonOffset(-1.0f, -1.0f), osg::StateAttribute::ON);
    LiveView view(graph.root);
    const auto move = [&](int object, double height)
    {
        graph.objects[std::size_t(object)]->setMatrix(
            osg::Matrixd::translate(object % 3, object / 3, height));
        CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
    };
    for (const int object : {0, 1, 2}) // each makes the static BVH be built again
        move(object, 0.3);
    REQUIRE(view.statistics().conversions == 2);
    CHECK(view.statistics().lastConversionReason == textOf(ConversionCause::NoStaticBvh));
    for (const int object : {0, 1, 3})
        move(object, 0.4);
    CHECK(view.statistics().conversions == 2);
    CHECK(view.statistics().patches >= 5);
}

TEST_CASE("at rest: raised faces move, deform, come and go alone", "[bridge]")
{
    LiveGraph graph;
    const osg::ref_ptr<osg::PolygonOffset> offset = new osg::PolygonOffset(-1.0f, -40.0f);
    const auto raise = [&](osg::Node& node)
    {
        node.getOrCreateStateSet()->setAttributeAndModes(offset, osg::StateAttribute::ON);
        node.getStateSet()->setAttributeAndModes(new osg::CullFace); // nothing to report
    };
    raise(*graph.objects[4]);
    LiveView view(graph.root);
    const auto edit = [&](const char* what, const std::function<void()>& change)
    {
        INFO(what);
        const std::vector<float> then = view.image();
        change();
        CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
        CHECK(differentPixels(view.lastImage(), then) > kRoundedPixels);
        CAPTURE(view.statistics().lastConversionReason, view.statistics().lastConversionPath);
        CHECK(view.statistics().conversions == 1);
    };
    const auto move = [&](double x)
    { graph.objects[4]->setMatrix(osg::Matrixd::translate(x, 1, 0.4)); };
    edit("out of the static BVH", [&] { move(0.8); });
    edit("again", [&] { move(0.6); });
    edit("other vertices", [&] { graph.deform(4, 0.2f); });
    edit("another colour",
         [&] { graph.objects[4]->getStateSet()->setAttributeAndModes(graph.materials[2]); });
    edit("gone", [&] { graph.group->removeChild(graph.objects[4]); });
    edit("back", [&] { graph.group->addChild(graph.objects[4]); });
    const osg::ref_ptr<osg::MatrixTransform> more = graph.newObject(3, 1.2, 0.5);
    raise(*more);
    edit("one more", [&] { graph.root->addChild(more); });
    edit("which moves", [&] { more->setMatrix(osg::Matrixd::translate(0.3, 0.5, 1.0)); });
}

TEST_CASE("at rest: a level of detail whose content is replaced is redone alone", "[bridge]")
{
    LiveGraph graph;
    const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    const auto newTile = [&](double x, double z)
    {
        const osg::ref_ptr<osg::MatrixTransform> tile = graph.newObject(3, 0.0, 0.0);
        tile->setMatrix(osg::Matrixd::translate(x, 0.45, z)); // in no plane of others
        return tile;
    };
    levels->addChild(newTile(1.3, 0.55), 0.0f, 1e6f);
    levels->addChild(newTile(0.2, 0.85), 0.0f, 1e6f);
    graph.root->addChild(levels);
    LiveView view(graph.root);
    const auto check = [&]
    {
        CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
        CAPTURE(view.statistics().lastConversionReason);
        CHECK(view.statistics().conversions == 1);
        LiveView fresh(graph.root);
        CHECK(view.statistics().conversion == fresh.statistics().conversion);
    };
    std::vector<float> placed;
    for (int time = 0; time < 3; ++time)
    {
        levels->setChild(0, newTile(1.3, 0.55));
        check();
        if (time == 1) placed = view.lastImage();
        if (time == 2) CHECK(placed == view.lastImage()); // an equal tile, bit for bit
    }
    const std::vector<float> then = view.lastImage();
    levels->setChild(0, newTile(0.9, 0.65));
    check();
    CHECK(differentPixels(view.lastImage(), then) > kRoundedPixels);
    levels->setRange(1, 0.0f, 1e-3f);
    check();
    levels->setRange(1, 0.0f, 1e6f);
    check();
    // A tile on two paths: its mesh is shared.
    const osg::ref_ptr<osg::MatrixTransform> again = new osg::MatrixTransform;
    again->setMatrix(osg::Matrixd::translate(-0.6, 0.2, 0.4));
    again->addChild(levels->getChild(1));
    levels->addChild(again, 0.0f, 1e6f);
    check();
    levels->removeChild(again);
    check();
    graph.materials[0]->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1, 0, 0, 1));
    check();
}

TEST_CASE("at rest: tiles below levels of detail take no static BVH along", "[bridge]")
{
    LiveGraph graph;
    std::vector<osg::ref_ptr<osg::LOD>> tiles;
    for (int tile = 0; tile < 2; ++tile)
    {
        tiles.push_back(new osg::LOD);
        tiles.back()->addChild(newFloor(), 0.0f, 1e6f);
        graph.root->addChild(tiles.back());
    }
    LiveView view(graph.root);
    const auto isInStaticBvh = [&](const Instance& instance)
    { return !instance.placed && view.scene()->meshes[instance.mesh]->positions.size() > 1000; };
    for (int time = 0; time < 5; ++time)
    {
        const std::vector<Instance>& instances = view.scene()->instances;
        CHECK(std::none_of(instances.begin(), instances.end(), isInStaticBvh));
        const osg::ref_ptr<osg::Geometry> floor = newFloor();
        auto& vertices = static_cast<osg::Vec3Array&>(*floor->getVertexArray());
        for (osg::Vec3& p : vertices)
            p.z() += 0.02f * float(time + 1) * std::sin(p.x());
        tiles[0]->setChild(0, floor);
        CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
        CAPTURE(view.statistics().lastConversionReason);
        CHECK(view.statistics().conversions == 1);
    }
}

TEST_CASE("at rest: what depends on the view is redone for the view of now", "[bridge]")
{
    LiveGraph graph;
    const osg::Vec3d fresh(1.2, -1.5, 4.0), elsewhere(-9.0, 14.0, 2.0); // fresh: of LiveView
    SECTION("billboards")
    {
        const osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard;
        billboard->setMode(osg::Billboard::POINT_ROT_WORLD);
        billboard->setNormal(osg::Vec3(0, 0, 1));
        billboard->addDrawable(graph.newObject(0, 0.0, 0.0)->getChild(0)->asGeometry(),
                               osg::Vec3(0.4f, 0.3f, 1.0f));
        graph.root->addChild(billboard);
    }
    SECTION("levels of detail")
    {
        const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
        levels->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
        levels->setCenter(osg::Vec3(1.0f, 0.5f, 0.0f));
        levels->setRadius(1.0f);
        const osg::ref_ptr<osg::MatrixTransform> near = graph.newObject(2, 0.0, 0.0);
        near->setMatrix(osg::Matrixd::translate(0.4, 0.3, 1.0));
        levels->addChild(near, 0.0f, 10.0f);
        levels->addChild(graph.newObject(1, 1.3, 0.55), 10.0f, 1e6f);
        graph.root->addChild(levels);
    }
    LiveView view(graph.root);
    view.recordEye(elsewhere);
    view.setDirty();
    view.update();
    const std::vector<float> then = view.image();
    const uint64_t conversions = view.statistics().conversions;
    view.recordEye(fresh);
    CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
    CHECK(differentPixels(view.lastImage(), then) > kRoundedPixels);
    CAPTURE(view.statistics().lastConversionReason);
    CHECK(view.statistics().conversions == conversions);
}
