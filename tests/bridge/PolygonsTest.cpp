// PolygonsTest.cpp - concave polygons and strips that restart. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/PolygonTriangles.h"
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include <osg/PrimitiveRestartIndex>

#include <cmath>
#include <random>

using namespace osgRayTrace::engine;

namespace
{

/// Returns the signed area of a triangle in the plane z = 0.
double areaOf(const Vec3d& a, const Vec3d& b, const Vec3d& c)
{
    return 0.5 * glm::cross(b - a, c - a).z;
}

/// Returns a star-shaped outline around the origin; its fan is nearly always wrong.
std::vector<Vec3d> star(std::mt19937& random, int corners)
{
    std::vector<Vec3d> outline;
    for (int i = 0; i < corners; ++i)
    {
        const double angle = 2.0 * M_PI * i / corners, radius = 0.1 + (random() % 1000) * 1e-3;
        outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    }
    return outline;
}

template <class Elements> void checkRestart(bool atLargest)
{
    using Index = typename Elements::value_type;
    const Index end = atLargest ? Index(-1) : Index(77);
    const Index indices[] = {end, 0, 1, 2, 3, end, end, 4, 5, end, 6, 7, 8, end};
    for (const GLenum mode :
         {GL_TRIANGLES, GL_TRIANGLE_STRIP, GL_TRIANGLE_FAN, GL_QUADS, GL_POLYGON})
    {
        const auto geometry = curveGeometry(9, new Elements(mode, 14, indices));
        osg::StateSet* state = geometry->getOrCreateStateSet();
        state->setMode(atLargest ? 0x8D69 : GL_PRIMITIVE_RESTART, osg::StateAttribute::ON);
        state->setAttribute(new osg::PrimitiveRestartIndex(atLargest ? 3 : 77)); // the largest wins
        const ConversionResult result = convertGraph(geometry);

        const auto runs = curveGeometry(9, new osg::DrawArrays(mode, 0, 4));
        runs->addPrimitiveSet(new osg::DrawArrays(mode, 6, 3));
        INFO("mode " << mode);
        const ConversionResult apart = convertGraph(runs);
        const auto& got = soleMesh(result).triangles;
        const auto& expected = soleMesh(apart).triangles;
        CHECK(std::vector<UVec3>(got.begin(), got.end()) ==
              std::vector<UVec3>(expected.begin(), expected.end()));
        CHECK(countOf(result, "skipped.index-out-of-range") == 0);
    }
}

} // namespace

TEST_CASE("polygons: ears cover a concave outline once", "[bridge]")
{
    std::mt19937 random(7);
    for (int corners = 4; corners < 60; ++corners)
    {
        const std::vector<Vec3d> outline = star(random, corners);
        double area = 0.0;
        for (int i = 0; i < corners; ++i)
            area += areaOf(Vec3d(0.0), outline[i], outline[(i + 1) % corners]);
        const std::vector<UVec3> triangles = concavePolygonTriangles(outline);
        if (triangles.empty()) continue; // a fan does for this outline
        CHECK(triangles.size() == outline.size() - 2);
        double sum = 0.0;
        for (const UVec3& t : triangles)
        {
            const double each = areaOf(outline[t.x], outline[t.y], outline[t.z]);
            CHECK(each >= 0.0); // none is turned over: as the sum is right, none overlaps another
            sum += each;
        }
        CHECK(sum == Approx(area).epsilon(1e-9));
    }
    const Vec3d dart[] = {{0.5, 0, 0}, {1, 1, 0}, {0.5, 0.6, 0}, {0, 1, 0}};
    CHECK(
        concavePolygonTriangles({dart[0], dart[1], dart[2], dart[3]}).empty()); // the fan is right
    CHECK(concavePolygonTriangles({dart[1], dart[2], dart[3], dart[0]}).size() == 2);
}

TEST_CASE("polygons: a fan where that is right or nothing else is", "[bridge]")
{
    const Vec3d a(0, 0, 0), b(1, 0, 0), c(1, 1, 0), d(0, 1, 0);
    CHECK(concavePolygonTriangles({a, b, c, d}).empty()); // convex
    CHECK(concavePolygonTriangles({a, b, c}).empty());
    CHECK(concavePolygonTriangles({a, c, b, d}).empty()); // cuts itself and has no area
    CHECK(concavePolygonTriangles({a, b, c, Vec3d(NAN, 0, 0), d}).empty());
    CHECK(concavePolygonTriangles({a, a, a, a, a}).empty());
    std::mt19937 random(7);
    CHECK(concavePolygonTriangles(star(random, int(kMostCorners) + 1)).empty());
}

TEST_CASE("restart: a run ends at the index, of each type and mode", "[bridge]")
{
    checkRestart<osg::DrawElementsUByte>(false);
    checkRestart<osg::DrawElementsUShort>(false);
    checkRestart<osg::DrawElementsUInt>(false);
    checkRestart<osg::DrawElementsUByte>(true);
    checkRestart<osg::DrawElementsUShort>(true);
    checkRestart<osg::DrawElementsUInt>(true);
}

TEST_CASE("restart: one geometry below two states is two meshes", "[bridge]")
{
    const GLushort indices[] = {0, 1, 2, 5, 3, 4};
    const auto strip = curveGeometry(6, new osg::DrawElementsUShort(GL_TRIANGLE_STRIP, 6, indices));
    osg::ref_ptr<osg::Group> root = new osg::Group, restarted = new osg::Group;
    restarted->getOrCreateStateSet()->setMode(GL_PRIMITIVE_RESTART, osg::StateAttribute::ON);
    restarted->getOrCreateStateSet()->setAttribute(new osg::PrimitiveRestartIndex(5));
    restarted->addChild(strip);
    root->addChild(strip);
    root->addChild(restarted);
    const ConversionResult result = convertGraph(root);
    REQUIRE(result.scene->instances.size() == 2);
    CHECK(result.scene->meshes[result.scene->instances[0].mesh]->triangles.size() == 4);
    CHECK(result.scene->meshes[result.scene->instances[1].mesh]->triangles.size() == 1);
}
