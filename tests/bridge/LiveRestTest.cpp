// LiveRestTest.cpp - what changes beside much that rests is redone alone. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osg/CullFace>
#include <osg/Geometry>
#include <osg/PolygonOffset>

#include <functional>

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
