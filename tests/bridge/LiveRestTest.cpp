// LiveRestTest.cpp - what changes beside much that rests is redone alone. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osg/Geometry>
#include <osg/PolygonOffset>

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
            vertices->push_back(
                osg::Vec3(0.05f * float(i) - 3.0f, 0.05f * float(j) - 3.0f, -0.3f));
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
