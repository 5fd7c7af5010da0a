// BadGeometryTest.cpp - bad vertices and indices are left out, and the rest stays. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/stability/geometry/Pictured.h"

#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <cmath>
#include <limits>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr unsigned int kSide = 100; // vertices; 1e4 in all
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct Grid
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    std::vector<GLuint> indices;

    /// Makes waves around the origin.
    Grid()
    {
        for (unsigned int y = 0; y < kSide; ++y)
            for (unsigned int x = 0; x < kSide; ++x)
            {
                const float u = 2.0f * float(x) / (kSide - 1) - 1.0f;
                const float v = 2.0f * float(y) / (kSide - 1) - 1.0f;
                vertices->push_back({u, v, 0.2f * std::sin(3.0f * u) * std::cos(2.0f * v)});
            }
        for (unsigned int y = 0; y + 1 < kSide; ++y)
            for (unsigned int x = 0; x + 1 < kSide; ++x)
            {
                const GLuint a = y * kSide + x;
                for (const GLuint i : {a, a + 1, a + 1 + kSide, a, a + 1 + kSide, a + kSide})
                    indices.push_back(i);
            }
    }

    void add(GLuint a, GLuint b, GLuint c)
    {
        for (const GLuint i : {a, b, c})
            indices.push_back(i);
    }

    osg::ref_ptr<osg::Geometry> geometry() const
    {
        osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        geometry->setVertexArray(vertices);
        geometry->addPrimitiveSet(new osg::DrawElementsUInt(
            GL_TRIANGLES, static_cast<unsigned int>(indices.size()), indices.data()));
        return geometry;
    }
};

void checkSamePicture(const ConversionResult& converted, const Picture& expected,
                      IntegratorKind kind)
{
    const Picture picture = pictureOf(converted, kind);
    CHECK(picture.progress.status.ok());
    CHECK(picture.progress.droppedSamples == 0);
    CHECK(differing(picture, expected) == 0);
}

} // namespace

TEST_CASE("stability 12: triangles without area are left out, the picture is that of the rest",
          "[stability]")
{
    Grid bad;
    const auto first = static_cast<GLuint>(bad.vertices->size());
    bad.vertices->push_back({0.5f, 0.5f, 0.5f});
    bad.vertices->push_back({0.5f, 0.5f, 0.5f});   // the same point
    bad.vertices->push_back({0.75f, 0.5f, 0.5f});  // on a line with both
    bad.vertices->push_back({0.625f, 0.5f, 0.5f}); // between them: no area
    std::vector<GLuint> good;
    good.swap(bad.indices);
    for (std::size_t i = 0; i < good.size(); i += 3)
    {
        // The bad triangles are among the good ones, not behind them.
        if (i == 300) bad.add(first, first, first);
        if (i == 3000) bad.add(first, first + 1, first + 1);
        if (i == 6000) bad.add(first, first + 1, first + 2);
        if (i == 9000) bad.add(first, first + 3, first + 2);
        if (i == 9003) bad.add(7, 7, 7);
        bad.add(good[i], good[i + 1], good[i + 2]);
    }
    const ConversionResult with = convertGraph(lit({bad.geometry()}));
    const ConversionResult without = convertGraph(lit({Grid().geometry()}));
    CHECK(countOf(with, "skipped.degenerate") == 5);
    CHECK(soleMesh(with).triangles.size() == soleMesh(without).triangles.size());
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
    {
        const Picture expected = pictureOf(without, kind);
        CHECK(expected.mean().y > 0.01f);
        checkSamePicture(with, expected, kind);
    }
}

TEST_CASE("stability 13: one vertex of 1e4 that is no place leaves a hole, and nothing else",
          "[stability]")
{
    constexpr GLuint kBad = 50 * kSide + 50;
    Grid holed;
    std::vector<GLuint> all;
    all.swap(holed.indices);
    for (std::size_t i = 0; i < all.size(); i += 3)
        if (all[i] != kBad && all[i + 1] != kBad && all[i + 2] != kBad)
            holed.add(all[i], all[i + 1], all[i + 2]);
    const ConversionResult hole = convertGraph(lit({holed.geometry()}));
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
    {
        const Picture expected = pictureOf(hole, kind);
        CHECK(differing(expected, pictureOf(convertGraph(lit({Grid().geometry()})), kind)) > 0);
        for (const float value : {kNaN, kInf, -kInf, 1e30f})
        {
            for (const unsigned int axis : {0u, 2u})
            {
                CAPTURE(int(kind), value, axis);
                Grid grid;
                (*grid.vertices)[kBad][axis] = value;
                const ConversionResult converted = convertGraph(lit({grid.geometry()}));
                CHECK(countOf(converted, "skipped.not-finite") == 6);
                checkSamePicture(converted, expected, kind);
            }
        }
    }
}

TEST_CASE("stability 14: bad indices and empty arrays are refused by drawable, with a message",
          "[stability]")
{
    const auto beyond = Grid().geometry();
    beyond->setName("beyond");
    beyond->removePrimitiveSet(0, 1);
    const GLuint far[] = {0, 1, 10000, 0, 1, 0xffffffffu, 5, 6, 7};
    beyond->addPrimitiveSet(new osg::DrawElementsUInt(GL_TRIANGLES, 8, far)); // the last cut short
    const auto empty = Grid().geometry();
    empty->setVertexArray(new osg::Vec3Array);
    const auto none = Grid().geometry();
    none->setVertexArray(nullptr);
    osg::ref_ptr<osg::Geometry> noIndices = Grid().geometry();
    noIndices->removePrimitiveSet(0, 1);
    noIndices->addPrimitiveSet(new osg::DrawElementsUInt(GL_TRIANGLES));
    osg::ref_ptr<osg::Geometry> two = Grid().geometry();
    two->removePrimitiveSet(0, 1);
    const GLuint pair[] = {0, 1};
    two->addPrimitiveSet(new osg::DrawElementsUInt(GL_TRIANGLES, 2, pair));

    forgetKindsOfWarnings();
    const Messages messages;
    const osg::ref_ptr<osg::Group> root =
        lit({beyond, empty, none, noIndices, two, Grid().geometry()});
    SceneConverter converter;
    const ConversionResult converted = converter.convert(inputFor(root));
    CHECK(countOf(converted, "skipped.index-out-of-range") == 2);
    CHECK(countOf(converted, "not-traced.no-vertices") == 2);
    CHECK(messages.timesSaid(
              "geometry 'Group/beyond': 2 triangles with an index beyond the vertex array") == 1);
    converter.forget();
    converter.convert(inputFor(root));
    CHECK(messages.timesSaid("Group/beyond") == 1); // not repeated
    REQUIRE(converted.scene->instances.size() == 1);
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
        checkSamePicture(converted, pictureOf(convertGraph(lit({Grid().geometry()})), kind), kind);
}
