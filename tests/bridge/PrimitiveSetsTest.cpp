// PrimitiveSetsTest.cpp - every primitive mode and index type gives the triangles of OpenGL.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include <osg/TriangleIndexFunctor>

#include <limits>

using namespace osgRayTrace::engine;

namespace
{

constexpr GLenum kModes[] = {GL_TRIANGLES, GL_TRIANGLE_STRIP, GL_TRIANGLE_FAN,
                             GL_QUADS,     GL_QUAD_STRIP,     GL_POLYGON};

/// Collects the triangles as OSG reads them: the independent reference.
struct CollectTriangles
{
    std::vector<UVec3> triangles;
    void operator()(unsigned int a, unsigned int b, unsigned int c)
    {
        triangles.emplace_back(a, b, c);
    }
};

/// Returns OSG's triangles without those that have equal corners: the vertices of these tests have
/// no other degenerate triangles.
std::vector<UVec3> expectedTriangles(const osg::Geometry& geometry)
{
    osg::TriangleIndexFunctor<CollectTriangles> functor;
    geometry.accept(functor);
    std::vector<UVec3> kept;
    for (const UVec3& t : functor.triangles)
        if (t.x != t.y && t.y != t.z && t.x != t.z) kept.push_back(t);
    return kept;
}

/// Returns the triangle turned so that the smallest index comes first, which keeps the front side.
UVec3 turned(const UVec3& t)
{
    if (t.x <= t.y && t.x <= t.z) return t;
    return t.y <= t.z && t.y <= t.x ? UVec3(t.y, t.z, t.x) : UVec3(t.z, t.x, t.y);
}

std::vector<UVec3> turned(const std::vector<UVec3>& triangles)
{
    std::vector<UVec3> result;
    for (const UVec3& t : triangles)
        result.push_back(turned(t));
    return result;
}

void checkAgainstOsg(const osg::ref_ptr<osg::Geometry>& geometry)
{
    const ConversionResult result = convertGraph(geometry);
    const std::vector<UVec3> expected = expectedTriangles(*geometry);
    REQUIRE_FALSE(expected.empty());
    REQUIRE(result.scene->instances.size() == 1);
    const auto& got = soleMesh(result).triangles;
    CHECK(turned(std::vector<UVec3>(got.begin(), got.end())) == turned(expected));
}

template <class Elements>
osg::ref_ptr<Elements> elements(GLenum mode, std::initializer_list<int> indices)
{
    osg::ref_ptr<Elements> set = new Elements(mode);
    for (const int index : indices)
        set->push_back(static_cast<typename Elements::value_type>(index));
    return set;
}

} // namespace

TEST_CASE("draw arrays: all modes match OSG's own triangles, with an offset and left-over vertices",
          "[bridge]")
{
    for (const GLenum mode : kModes)
        for (const int count : {4, 5, 8, 11})
        {
            INFO("mode " << mode << ", " << count << " vertices");
            checkAgainstOsg(curveGeometry(20, new osg::DrawArrays(mode, 3, count)));
        }
}

TEST_CASE("draw elements: all modes and index types match OSG's own triangles", "[bridge]")
{
    const auto indices = {0, 2, 1, 5, 4, 7, 3, 6, 9, 8, 11, 10};
    for (const GLenum mode : kModes)
    {
        INFO("mode " << mode);
        checkAgainstOsg(curveGeometry(12, elements<osg::DrawElementsUByte>(mode, indices)));
        checkAgainstOsg(curveGeometry(12, elements<osg::DrawElementsUShort>(mode, indices)));
        checkAgainstOsg(curveGeometry(12, elements<osg::DrawElementsUInt>(mode, indices)));
    }
}

TEST_CASE("draw array lengths and multi draw arrays: each length is its own strip", "[bridge]")
{
    for (const GLenum mode : kModes)
    {
        INFO("mode " << mode);
        osg::ref_ptr<osg::DrawArrayLengths> lengths = new osg::DrawArrayLengths(mode, 1);
        for (const int length : {4, 5, 2, 8})
            lengths->push_back(length);
        checkAgainstOsg(curveGeometry(20, lengths));
    }
    osg::ref_ptr<osg::MultiDrawArrays> multi = new osg::MultiDrawArrays(GL_TRIANGLE_STRIP);
    multi->add(0, 4);
    multi->add(10, 5);
    checkAgainstOsg(curveGeometry(20, multi));
}

TEST_CASE("several primitive sets of different kinds become one mesh in drawing order", "[bridge]")
{
    const auto geometry = curveGeometry(20, new osg::DrawArrays(GL_TRIANGLE_FAN, 0, 5));
    geometry->addPrimitiveSet(elements<osg::DrawElementsUInt>(GL_TRIANGLES, {9, 8, 7, 12, 13, 14}));
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_QUADS, 8, 8));
    checkAgainstOsg(geometry);
}

TEST_CASE("points, lines, adjacency and patches are counted as not traced", "[bridge]")
{
    const auto geometry = curveGeometry(20, new osg::DrawArrays(GL_POINTS, 0, 20));
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_LINES, 0, 20));
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_LINE_LOOP, 0, 20));
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES_ADJACENCY, 0, 12));
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_PATCHES, 0, 12));
    const ConversionResult result = convertGraph(geometry);
    CHECK(result.scene->instances.empty());
    CHECK(countOf(result, "not-traced.points") == 1);
    CHECK(countOf(result, "not-traced.lines") == 2);
    CHECK(countOf(result, "not-traced.adjacency") == 1);
    CHECK(countOf(result, "not-traced.patches") == 1);
    CHECK(countOf(result, "converted.geometry") == 0);
}

TEST_CASE("indices out of range drop their triangle only, and are counted",
          "[bridge][stability 14]")
{
    const auto good = elements<osg::DrawElementsUInt>(GL_TRIANGLES, {0, 1, 2, 2, 1, 20, 3, 4, 5});
    ConversionResult result = convertGraph(curveGeometry(20, good));
    CHECK(soleMesh(result).triangles.size() == 2);
    CHECK(countOf(result, "skipped.index-out-of-range") == 1);

    // A primitive restart index cuts a strip in two.
    const auto strip =
        elements<osg::DrawElementsUShort>(GL_TRIANGLE_STRIP, {0, 1, 2, 3, 0xffff, 4, 5, 6});
    result = convertGraph(curveGeometry(20, strip));
    CHECK(soleMesh(result).triangles.size() == 3);
    CHECK(countOf(result, "skipped.index-out-of-range") == 3);

    const auto none = elements<osg::DrawElementsUInt>(GL_TRIANGLES, {70, 71, 72});
    result = convertGraph(curveGeometry(20, none));
    CHECK(result.scene->instances.empty());
    CHECK(countOf(result, "skipped.index-out-of-range") == 1);
}

TEST_CASE("draw arrays beyond the vertices are cut, whatever their count says", "[bridge]")
{
    const int huge = std::numeric_limits<int>::max();
    ConversionResult result =
        convertGraph(curveGeometry(6, new osg::DrawArrays(GL_TRIANGLES, 0, huge)));
    CHECK(soleMesh(result).triangles.size() == 2);
    CHECK(countOf(result, "skipped.index-out-of-range") == uint64_t(huge) / 3 - 2);

    CHECK(convertGraph(curveGeometry(6, new osg::DrawArrays(GL_TRIANGLES, -3, 6)))
              .scene->instances.empty());
    CHECK(convertGraph(curveGeometry(6, new osg::DrawArrays(GL_TRIANGLES, huge, huge)))
              .scene->instances.empty());

    osg::ref_ptr<osg::DrawArrayLengths> lengths = new osg::DrawArrayLengths(GL_TRIANGLE_STRIP, 0);
    for (const int length : {-5, 3, huge, huge})
        lengths->push_back(length);
    result = convertGraph(curveGeometry(6, lengths));
    CHECK(soleMesh(result).triangles.size() == 2);
}

TEST_CASE("empty and broken geometry converts to nothing and does not crash",
          "[bridge][stability 14]")
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(new osg::Geometry);
    osg::ref_ptr<osg::Geometry> noVertices = new osg::Geometry;
    noVertices->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    root->addChild(noVertices);
    osg::ref_ptr<osg::Geometry> noValues = new osg::Geometry;
    noValues->setVertexArray(new osg::Vec3Array);
    noValues->addPrimitiveSet(new osg::DrawElementsUInt(GL_TRIANGLES));
    root->addChild(noValues);
    osg::ref_ptr<osg::Geometry> matrices = new osg::Geometry;
    matrices->setVertexArray(new osg::MatrixdArray(3));
    matrices->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    root->addChild(matrices);
    const ConversionResult result = convertGraph(root);
    CHECK(result.scene->instances.empty());
    CHECK(result.scene->materials.size() == 1);
    CHECK(countOf(result, "not-traced.no-vertices") == 3);
    CHECK(countOf(result, "skipped.vertex-type") == 1);

    CHECK(convertGraph(nullptr).scene != nullptr);
}

TEST_CASE("degenerate triangles are dropped and counted", "[bridge]")
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (const float x : {0.1f, 0.2f, 0.3f})
        vertices->push_back({x, 2.0f * x, -x}); // on a line, up to the rounding of 0.3
    vertices->push_back({1.0f, 0.0f, 0.0f});
    vertices->push_back({2.0f, 0.0f, 0.0f});
    vertices->push_back({4.0f, 0.0f, 0.0f});
    geometry->setVertexArray(vertices);
    geometry->addPrimitiveSet(
        elements<osg::DrawElementsUInt>(GL_TRIANGLES, {0, 0, 3, 3, 4, 5, 0, 3, 1, 0, 3, 3}));
    const ConversionResult result = convertGraph(geometry);
    REQUIRE(soleMesh(result).triangles.size() == 1);
    CHECK(soleMesh(result).triangles[0] == UVec3(0, 3, 1));
    CHECK(countOf(result, "skipped.degenerate") == 3);
}
