// PointSolidsTest.cpp - points that are traced as spheres, and lines as capsules.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/api/Picks.h"
#include "tests/bridge/Graphs.h"

#include "osgRayTrace/bridge/geometry/PointSolids.h"
#include "osgRayTrace/bridge/geometry/SolidShape.h"

#include <osgRayTrace/Renderer>

#include <osg/PrimitiveRestartIndex>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

using Corners = std::vector<osg::Vec3>;

osg::ref_ptr<osg::Geometry> geometryOf(const Corners& corners, osg::PrimitiveSet* primitives)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(new osg::Vec3Array(corners.begin(), corners.end()));
    geometry->addPrimitiveSet(primitives);
    return geometry;
}

osg::ref_ptr<osg::Geometry> drawn(GLenum mode, const Corners& corners)
{
    return geometryOf(corners, new osg::DrawArrays(mode, 0, static_cast<int>(corners.size())));
}

ConversionInput solidInput(osg::Node* root, float radius = 0.25f)
{
    ConversionInput input = inputFor(root);
    input.pointRadius = radius;
    return input;
}

ConversionResult solidsOf(osg::Node* root, float radius = 0.25f)
{
    SceneConverter converter;
    return converter.convert(solidInput(root, radius));
}

/// Returns six times the volume that closed triangles enclose; negative: they look inwards.
double volumeOf(const Mesh& mesh)
{
    double volume = 0.0;
    for (const UVec3& t : mesh.triangles)
        volume += glm::dot(Vec3d(mesh.positions[t.x]),
                           glm::cross(Vec3d(mesh.positions[t.y]), Vec3d(mesh.positions[t.z])));
    return volume;
}

Vec3d largestOf(const Mesh& mesh)
{
    Vec3d largest(0.0);
    for (const UVec3& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            largest = glm::max(largest, glm::abs(Vec3d(mesh.positions[t[corner]])));
    return largest;
}

/// Returns whether each edge belongs to two triangles, which run through it in both directions.
bool isClosed(const std::vector<UVec3>& triangles)
{
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (const UVec3& t : triangles)
        for (int corner = 0; corner < 3; ++corner)
            if (++edges[{t[corner], t[(corner + 1) % 3]}] > 1) return false;
    return std::all_of(edges.begin(), edges.end(),
                       [&edges](const auto& edge) {
                           return edges.count({edge.first.second, edge.first.first}) == 1;
                       });
}

constexpr int kSize = 96;
constexpr double kFovyDegrees = 30.0;

/// Returns the direction of a pixel's ray from (0, -10, 0), with y = 1.
osg::Vec3d rayOf(int x, int y)
{
    const double half = std::tan(osg::DegreesToRadians(kFovyDegrees / 2.0));
    return {half * (2.0 * (x + 0.5) / kSize - 1.0), 1.0, half * (2.0 * (y + 0.5) / kSize - 1.0)};
}

osg::ref_ptr<osg::Image> channelOf(osg::Node* scene, float radius, const char* channel)
{
    const osg::ref_ptr<Renderer> renderer = new Renderer;
    renderer->setScene(scene);
    renderer->setSize(kSize, kSize);
    renderer->setViewMatrix(osg::Matrixd::lookAt({0.0, -10.0, 0.0}, {0.0, 0.0, 0.0}, osg::Z_AXIS));
    renderer->setProjectionMatrix(osg::Matrixd::perspective(kFovyDegrees, 1.0, 0.1, 100.0));
    renderer->getSettings()->setPointRadius(radius);
    renderer->getSettings()->setMaxPasses(1);
    REQUIRE(renderer->render());
    const osg::ref_ptr<osg::Image> image = renderer->getChannelImage(channel);
    REQUIRE(image);
    return image;
}

/// Returns the distance between the ray through a pixel and a segment.
double distanceTo(const osg::Vec3d& ray, const osg::Vec3d& from, const osg::Vec3d& to)
{
    osg::Vec3d direction = ray;
    direction.normalize();
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 2000; ++i)
    {
        const osg::Vec3d toPoint = from + (to - from) * (i / 2000.0) - osg::Vec3d(0.0, -10.0, 0.0);
        nearest = std::min(nearest, (toPoint ^ direction).length());
    }
    return nearest;
}

/// Largest share of the radius by which the facets of a few solids are off.
constexpr double kFinest = 0.0078;

} // namespace

TEST_CASE("point solids: shapes are closed, look outwards and keep to their radius", "[bridge]")
{
    struct Level
    {
        std::size_t count, triangles;
        double error;
    };
    // Radii are off by (1 - d) / (1 + d), where d is the least distance of a facet from the centre.
    for (const Level& level :
         {Level{1, 512, kFinest}, Level{2048, 512, kFinest}, Level{2049, 392, 0.0101},
          Level{10000, 72, 0.0392}, Level{400000, 32, 0.1011}})
    {
        CAPTURE(level.count);
        const SolidShapes& shapes = solidShapes(level.count);
        REQUIRE(shapes.sphere.triangles.size() == level.triangles);
        CHECK(isClosed(shapes.sphere.triangles));
        CHECK(isClosed(shapes.capsule.triangles));
        double nearest = 2.0;
        for (const UVec3& t : shapes.sphere.triangles)
        {
            const Vec3d a = shapes.sphere.vertices[t.x].direction * shapes.outset,
                        b = shapes.sphere.vertices[t.y].direction * shapes.outset,
                        c = shapes.sphere.vertices[t.z].direction * shapes.outset;
            nearest = std::min(nearest, glm::dot(glm::normalize(glm::cross(b - a, c - a)), a));
        }
        CHECK(nearest > 1.0 - level.error);
        CHECK(shapes.outset < 1.0 + level.error);
        CHECK(1.0 - nearest == Approx(shapes.outset - 1.0).margin(1e-12));
    }
}

TEST_CASE("point solids: a point covers the pixels of the sphere, at its distances", "[bridge]")
{
    const osg::ref_ptr<osg::Geometry> point = drawn(GL_POINTS, {{0.3f, 0.0f, -0.2f}});
    constexpr float kRadius = 1.5f;
    const osg::ref_ptr<osg::Image> distances = channelOf(point, kRadius, "distance");
    int hits = 0, misses = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
        {
            osg::Vec3d ray = rayOf(x, y);
            ray.normalize();
            const osg::Vec3d toCentre(0.3, 10.0, -0.2);
            const double b = toCentre * ray, apart = (toCentre ^ ray).length();
            const float found = reinterpret_cast<const float*>(distances->data(x, y))[0];
            if (apart > kRadius * (1.0 + kFinest)) misses += std::isinf(found) ? 1 : -100000;
            if (apart > 0.9 * kRadius) continue;
            // Between spheres of both extreme radii.
            const auto depthOf = [=](double radius)
            { return b - std::sqrt(radius * radius - apart * apart); };
            hits += found >= depthOf(kRadius * (1.0 + kFinest)) - 1e-4 &&
                            found <= depthOf(kRadius * (1.0 - kFinest)) + 1e-4
                        ? 1
                        : -100000;
        }
    CHECK(hits > 1000);
    CHECK(misses > 5000);
}

TEST_CASE("point solids: a line has the silhouette of a capsule", "[bridge]")
{
    const osg::Vec3d from(-1.2, 0.5, -0.8), to(1.0, -0.5, 0.9);
    const osg::ref_ptr<osg::Geometry> line = drawn(GL_LINES, {osg::Vec3(from), osg::Vec3(to)});
    constexpr double kRadius = 0.4;
    const osg::ref_ptr<osg::Image> distances =
        channelOf(line, static_cast<float>(kRadius), "distance");
    int hits = 0, misses = 0, wrong = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
        {
            const double apart = distanceTo(rayOf(x, y), from, to);
            const bool hit =
                std::isfinite(reinterpret_cast<const float*>(distances->data(x, y))[0]);
            hits += hit;
            misses += !hit;
            wrong += apart < kRadius * (1.0 - kFinest) - 1e-3 && !hit;
            wrong += apart > kRadius * (1.0 + kFinest) + 1e-3 && hit;
        }
    CHECK(hits > 600);
    CHECK(misses > 5000);
    CHECK(wrong == 0);
}

TEST_CASE("point solids: each mode has its points and segments", "[bridge]")
{
    const Corners corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    struct Mode
    {
        GLenum mode;
        uint64_t points, lines;
    };
    for (const Mode& mode : {Mode{GL_POINTS, 4, 0}, Mode{GL_LINES, 0, 2}, Mode{GL_LINE_STRIP, 0, 3},
                             Mode{GL_LINE_LOOP, 0, 4}})
    {
        CAPTURE(mode.mode);
        const ConversionResult result = solidsOf(drawn(mode.mode, corners));
        CHECK(countOf(result, "converted.point") == mode.points);
        CHECK(countOf(result, "converted.line") == mode.lines);
        CHECK(countOf(result, "not-traced.points") + countOf(result, "not-traced.lines") == 0);
        REQUIRE(result.scene->instances.size() == 1);
        CHECK(soleMesh(result).triangles.size() == 512 * mode.points + 576 * mode.lines);
        CHECK(volumeOf(soleMesh(result)) > 0.0);
    }

    const GLushort indices[] = {0, 1, 2, 65535, 3, 0};
    const osg::ref_ptr<osg::Geometry> strips =
        geometryOf(corners, new osg::DrawElementsUShort(GL_LINE_STRIP, 6, indices));
    osg::StateSet* state = strips->getOrCreateStateSet();
    state->setMode(GL_PRIMITIVE_RESTART, osg::StateAttribute::ON);
    state->setAttribute(new osg::PrimitiveRestartIndex(65535));
    CHECK(countOf(solidsOf(strips), "converted.line") == 3);
}

TEST_CASE("point solids: what has no place is counted, what has no length is a sphere", "[bridge]")
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const ConversionResult points = solidsOf(drawn(GL_POINTS, {{0, 0, 0}, {nan, 0, 0}, {1, 0, 0}}));
    CHECK(countOf(points, "converted.point") == 2);
    CHECK(countOf(points, "skipped.point-or-line") == 1);

    const GLuint indices[] = {0, 1, 1, 7};
    const ConversionResult beyond = solidsOf(
        geometryOf({{0, 0, 0}, {1, 0, 0}}, new osg::DrawElementsUInt(GL_LINES, 4, indices)));
    CHECK(countOf(beyond, "converted.line") == 1);
    CHECK(countOf(beyond, "skipped.point-or-line") == 1);

    const ConversionResult many =
        solidsOf(geometryOf({{0, 0, 0}, {1, 0, 0}}, new osg::DrawArrays(GL_POINTS, 0, 1000)));
    CHECK(countOf(many, "converted.point") == 2);
    CHECK(countOf(many, "skipped.point-or-line") == 998);

    const ConversionResult dot = solidsOf(drawn(GL_LINES, {{0, 0, 0}, {0, 0, 0}}));
    CHECK(countOf(dot, "converted.line") == 1);
    CHECK(soleMesh(dot).triangles.size() == 512);
    CHECK(largestOf(soleMesh(dot)).x == Approx(0.25).epsilon(kFinest));

    // Floats leave a tiny solid that is far from the origin no area.
    const ConversionResult tiny = solidsOf(drawn(GL_POINTS, {{1e6f, 0, 0}, {0, 0, 0}}), 1e-9f);
    for (const UVec3& t : soleMesh(tiny).triangles)
    {
        const SharedArray<Vec3>& p = soleMesh(tiny).positions;
        CHECK(glm::length(
                  glm::cross(Vec3d(p[t.y]) - Vec3d(p[t.x]), Vec3d(p[t.z]) - Vec3d(p[t.x]))) > 0.0);
    }
}

TEST_CASE("point solids: the transform scales and mirrors them", "[bridge]")
{
    const osg::ref_ptr<osg::Geometry> point = drawn(GL_POINTS, {{0, 0, 0}});
    for (const double mirror : {1.0, -1.0})
    {
        CAPTURE(mirror);
        const ConversionResult result =
            solidsOf(placed(osg::Matrixd::scale(mirror * 4.0, 2.0, 1.0), point));
        const Mesh& mesh = soleMesh(result);
        const Vec3d extent = largestOf(mesh) * result.scene->unit;
        CHECK(extent.x == Approx(1.0).epsilon(kFinest));
        CHECK(extent.y == Approx(0.5).epsilon(kFinest));
        CHECK(extent.z == Approx(0.25).epsilon(kFinest));
        CHECK(volumeOf(mesh) > 0.0);
        const UVec3& t = mesh.triangles[17];
        const Vec3 face = glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                     mesh.positions[t.z] - mesh.positions[t.x]);
        CHECK(glm::dot(glm::normalize(face), mesh.normals[t.x]) > 0.9f);
    }
}

TEST_CASE("point solids: they have the colours of their vertices, and light in any state",
          "[bridge]")
{
    const osg::ref_ptr<osg::Geometry> line = drawn(GL_LINES, {{-2, 0, 0}, {2, 0, 0}});
    const osg::Vec4 colors[] = {{1, 0, 0, 1}, {0, 1, 0, 1}};
    line->setColorArray(new osg::Vec4Array(2, colors), osg::Array::BIND_PER_VERTEX);
    line->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    const ConversionResult result = solidsOf(line);
    const Mesh& mesh = soleMesh(result);
    REQUIRE(mesh.colors.size() == mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        CHECK(mesh.colors[i] == (mesh.positions[i].x < 0.0f ? Vec4(1, 0, 0, 1) : Vec4(0, 1, 0, 1)));
    CHECK(soleMaterial(result).lit);
    CHECK(soleMaterial(result).vertexColorUse == VertexColorUse::AmbientAndDiffuse);

    // One colour for each primitive set; and triangles beside them are as they were.
    const osg::ref_ptr<osg::Geometry> mixed = triangleGeometry();
    mixed->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 1, 1));
    mixed->setColorArray(new osg::Vec4Array(2, colors), osg::Array::BIND_PER_PRIMITIVE_SET);
    mixed->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    const ConversionResult both = solidsOf(mixed);
    const Mesh& beside = soleMesh(both);
    REQUIRE(beside.triangles.size() == 513);
    CHECK_FALSE(soleMaterial(both).lit);
    for (std::size_t i = 0; i < 513; ++i)
        for (int corner = 0; corner < 3; ++corner)
        {
            const uint32_t vertex = beside.triangles[i][corner];
            CHECK(beside.colors[vertex] == (i == 0 ? Vec4(1, 0, 0, 1) : Vec4(0, 1, 0, 1)));
            if (i == 0) CHECK(beside.normals[vertex] == Vec3(0.0f, 0.0f, 1.0f));
        }
}

TEST_CASE("point solids: OSG draws what is not traced, and only that", "[bridge]")
{
    const osg::ref_ptr<osg::Geometry> line = drawn(GL_LINES, {{-2, 0, 0}, {2, 0, 0}});
    const osg::ref_ptr<osg::Group> group = new osg::Group; // parts are below the decorator
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    group->addChild(scene);
    scene->addChild(line);
    const auto partsOf = [&group](float radius)
    {
        ConversionInput input = solidInput(group, radius);
        input.rasterizesRest = true;
        SceneConverter converter;
        const ConversionResult result = converter.convert(input);
        return std::make_pair(result.rasterized ? result.rasterized->size() : 0,
                              countOf(result, "not-traced.lines"));
    };
    CHECK(partsOf(0.0f) == std::make_pair(std::size_t(1), uint64_t(1)));
    CHECK(partsOf(0.1f) == std::make_pair(std::size_t(0), uint64_t(0)));

    const auto vertices = static_cast<unsigned int>(kMostSolids + 1);
    line->setVertexArray(new osg::Vec3Array(vertices));
    line->setPrimitiveSet(0, new osg::DrawArrays(GL_POINTS, 0, static_cast<int>(vertices)));
    const ConversionResult tooMany = solidsOf(line);
    CHECK(countOf(tooMany, "warned.too-many-points") == 1);
    CHECK(countOf(tooMany, "not-traced.points") == 1);
    CHECK(tooMany.scene->instances.empty());
}

TEST_CASE("point solids: edits and other radii are converted", "[bridge]")
{
    const osg::ref_ptr<osg::Geometry> point = drawn(GL_POINTS, {{0, 0, 0}});
    SceneConverter converter;
    CHECK(largestOf(soleMesh(converter.convert(solidInput(point)))).x ==
          Approx(0.25).epsilon(kFinest));
    CHECK(largestOf(soleMesh(converter.convert(solidInput(point, 0.5f)))).x ==
          Approx(0.5).epsilon(kFinest));
    auto& vertices = static_cast<osg::Vec3Array&>(*point->getVertexArray());
    vertices.push_back(osg::Vec3(2.0f, 0.0f, 0.0f));
    vertices.dirty();
    point->setPrimitiveSet(0, new osg::DrawArrays(GL_POINTS, 0, 2));
    const ConversionResult edited = converter.convert(solidInput(point, 0.5f));
    CHECK(countOf(edited, "converted.point") == 2);
}

TEST_CASE("point solids: a pick finds the primitive", "[bridge]")
{
    const osg::ref_ptr<osg::Geometry> geometry = triangleGeometry();
    auto& vertices = static_cast<osg::Vec3Array&>(*geometry->getVertexArray());
    for (int i = 0; i < 5; ++i)
        vertices.push_back(osg::Vec3(2.0f + float(i), float(i % 2), 0.0f));
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_LINE_STRIP, 3, 5));
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, 1));
    const osg::Vec3 up(0.0f, 0.0f, 1.0f);
    geometry->setNormalArray(new osg::Vec3Array(1, &up), osg::Array::BIND_OVERALL);
    const osg::ref_ptr<RayTracedScene> root = new RayTracedScene;
    root->getSettings()->setPointRadius(0.1f);
    root->addChild(geometry);
    const auto pickAt = [&root](double x, double y) {
        return test::picksByRay(*root, {{x, y, 5.0}, {x, y, -5.0}});
    };

    for (int segment = 0; segment < 4; ++segment)
    {
        CAPTURE(segment);
        const test::Picks picks = pickAt(2.5 + segment, 0.5);
        REQUIRE(picks.size() == 1);
        CHECK(picks[0].drawable == geometry);
        CHECK(picks[0].primitiveIndex == static_cast<unsigned int>(1 + segment));
        CHECK(picks[0].getWorldIntersectPoint().z() == Approx(0.1).epsilon(0.02));
        CHECK(picks[0].getWorldIntersectNormal().z() > 0.8);
    }
    REQUIRE(pickAt(0.01, 0.01).size() == 1);
    CHECK(pickAt(0.01, 0.01)[0].primitiveIndex == 5);
    REQUIRE(pickAt(0.3, 0.3).size() == 1);
    CHECK(pickAt(0.3, 0.3)[0].primitiveIndex == 0);
    CHECK(pickAt(2.5, 0.9).empty());
}
