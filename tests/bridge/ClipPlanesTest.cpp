// ClipPlanesTest.cpp - what clip planes leave of geometries, and what clipping costs. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/MeshClipper.h"
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include <osg/ClipNode>
#include <osg/ShapeDrawable>

#include <cmath>
#include <set>

using namespace osgRayTrace::engine;

namespace
{

osg::ref_ptr<osg::ClipNode> clipped(const osg::Vec4d& plane, osg::Node* child)
{
    osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
    clip->addClipPlane(new osg::ClipPlane(0, plane));
    if (child) clip->addChild(child);
    return clip;
}

osg::ref_ptr<osg::ShapeDrawable> ball()
{
    return new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 1.0f));
}

double areaOf(const Mesh& mesh)
{
    double area = 0.0;
    for (const UVec3& t : mesh.triangles)
    {
        const Vec3d a(mesh.positions[t.x]);
        area += 0.5 * glm::length(glm::cross(Vec3d(mesh.positions[t.y]) - a,
                                             Vec3d(mesh.positions[t.z]) - a));
    }
    return area;
}

/// Returns a square of 2 * n * n triangles, from 0 to 1 at z = 0, with uv = xy and colours of x.
Mesh square(unsigned int n)
{
    std::vector<Vec3> positions, normals;
    std::vector<Vec2> uvs;
    std::vector<Vec4> colors;
    std::vector<UVec3> triangles;
    for (unsigned int y = 0; y <= n; ++y)
        for (unsigned int x = 0; x <= n; ++x)
        {
            positions.emplace_back(float(x) / float(n), float(y) / float(n), 0.0f);
            normals.emplace_back(0.0f, 0.0f, 1.0f);
            uvs.emplace_back(positions.back());
            colors.emplace_back(positions.back().x, 0.0f, 0.0f, 1.0f);
            if (x == n || y == n) continue;
            const unsigned int i = y * (n + 1) + x;
            triangles.emplace_back(i, i + 1, i + n + 1);
            triangles.emplace_back(i + 1, i + n + 2, i + n + 1);
        }
    Mesh mesh;
    mesh.positions = std::move(positions);
    mesh.normals = std::move(normals);
    mesh.uvs = std::move(uvs);
    mesh.colors = std::move(colors);
    mesh.triangles = std::move(triangles);
    return mesh;
}

} // namespace

TEST_CASE("clip planes: the area that is left, by formula, with values that go on smoothly",
          "[bridge]")
{
    Mesh mesh = square(7);
    clip(mesh, {Vec4d(2.0, 0.0, 0.0, -0.5), Vec4d(-1.0, -1.0, 0.0, 1.5)}); // x >= 1/4, x + y <= 3/2
    CHECK(areaOf(mesh) == Approx(0.75 - 0.125).epsilon(1e-6));
    for (const UVec3& t : mesh.triangles)
        for (const uint32_t i : {t.x, t.y, t.z})
        {
            const Vec3 p = mesh.positions[i];
            CHECK(p.x >= 0.25f - 1e-6f);
            CHECK(p.x + p.y <= 1.5f + 1e-6f);
            CHECK(glm::length(mesh.uvs[i] - Vec2(p)) < 1e-6f);
            CHECK(std::fabs(mesh.colors[i].x - p.x) < 1e-6f);
            CHECK(mesh.normals[i] == Vec3(0.0f, 0.0f, 1.0f));
        }
}

// A hole would let rays through between two triangles that were cut.
TEST_CASE("clip planes: neighbours share the vertices of a cut", "[bridge]")
{
    const ConversionResult result = convertGraph(clipped({0.3, 0.5, -0.8, 0.1}, ball()));
    const Mesh& mesh = soleMesh(result);
    // The directed edges between places that have no opposite edge are the rim, which lies in the
    // plane.
    using Edge = std::pair<std::array<float, 3>, std::array<float, 3>>;
    const auto place = [&](uint32_t i)
    {
        const Vec3 p = mesh.positions[i];
        return std::array<float, 3>{p.x, p.y, p.z};
    };
    std::set<Edge> edges;
    for (const UVec3& t : mesh.triangles)
        for (int c = 0; c < 3; ++c)
            edges.insert({place(t[c]), place(t[(c + 1) % 3])});
    int rim = 0;
    for (const Edge& edge : edges)
    {
        if (edges.count({edge.second, edge.first})) continue;
        ++rim;
        for (const auto& p : {edge.first, edge.second})
            CHECK(std::fabs(0.3 * p[0] + 0.5 * p[1] - 0.8 * p[2] + 0.1) < 1e-6);
    }
    CHECK(rim > 20);
}

TEST_CASE("clip planes: of each number the last one, for states that switch it on", "[bridge]")
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(clipped({1.0, 0.0, 0.0, -0.25}, triangleGeometry())); // the next one replaces it
    root->addChild(placed(osg::Matrixd::translate(0.5, 0.0, 0.0),
                          clipped({1.0, 0.0, 0.0, 0.0}, triangleGeometry())));
    root->addChild(triangleGeometry()); // this one has no clip state
    const ConversionResult result = convertGraph(root);
    REQUIRE(result.scene->instances.size() == 3);
    const auto areaAt = [&](std::size_t i)
    { return areaOf(*result.scene->meshes[result.scene->instances[i].mesh]); };
    CHECK(areaAt(0) == Approx(0.125)); // x >= 1/2
    CHECK(areaAt(1) == Approx(0.5));
    CHECK(areaAt(2) == Approx(0.5));
}

TEST_CASE("clip planes: only what they cross is cut, also when they move", "[bridge]")
{
    const auto shared = ball();
    osg::ref_ptr<osg::ClipNode> clip = clipped({1.0, 0.0, 0.0, 0.25}, nullptr);
    for (const double x : {-10.0, 0.0, 10.0, 20.0})
        clip->addChild(placed(osg::Matrixd::translate(x, 0.0, 0.0), shared));
    clip->addChild(placed(osg::Matrixd::translate(30.0, 0.0, 0.0), triangleGeometry()));
    SceneConverter converter;
    const ConversionResult first = converter.convert(inputFor(clip));
    CHECK(countOf(first, "not-traced.clipped-away") == 1);
    REQUIRE(first.scene->instances.size() == 4);
    CHECK_FALSE(first.scene->instances[0].placed);
    CHECK(first.scene->instances[2].placed); // instances that are in place come first
    CHECK(first.scene->instances[2].mesh == first.scene->instances[3].mesh);
    CHECK(converter.convert(inputFor(clip)).scene == first.scene);

    clip->getClipPlane(0)->setClipPlane(1.0, 0.0, 0.0, 0.5);
    const ConversionResult second = converter.convert(inputFor(clip));
    const auto meshOf = [](const ConversionResult& result, std::size_t i)
    { return result.scene->meshes[result.scene->instances[i].mesh]; };
    CHECK(meshOf(second, 0) != meshOf(first, 0));
    CHECK(areaOf(*meshOf(second, 0)) > areaOf(*meshOf(first, 0)));
    for (const std::size_t i : {1, 2, 3})
        CHECK(meshOf(second, i) == meshOf(first, i));
}

TEST_CASE("clip planes: bad ones are named, an empty one keeps everything", "[bridge]")
{
    osg::ref_ptr<osg::ClipNode> clip = clipped({0.0, 0.0, 0.0, 0.0}, triangleGeometry());
    clip->addClipPlane(new osg::ClipPlane(1, std::nan(""), 0.0, 0.0, 1.0));
    clip->addClipPlane(new osg::ClipPlane(40, 1.0, 0.0, 0.0, -5.0));
    const ConversionResult result = convertGraph(clip);
    CHECK(areaOf(soleMesh(result)) == Approx(0.5));
    CHECK(countOf(result, "skipped.clip-plane") == 2);
}

TEST_CASE("clip planes: in a scene far away and in tiny units", "[bridge]")
{
    for (const double size : {1e-12, 1.0, 1e12})
    {
        const auto root = placed(osg::Matrixd::scale(size, size, size) *
                                     osg::Matrixd::translate(6.0e6 * size, 0, 0),
                                 clipped({1.0, 0.0, 0.0, -0.5}, triangleGeometry()));
        ConversionInput input = inputFor(root);
        input.origin.set(6.0e6 * size, 0.0, 0.0);
        SceneConverter converter;
        const ConversionResult result = converter.convert(input);
        const double scale = size / result.scene->unit;
        CHECK(areaOf(soleMesh(result)) == Approx(0.125 * scale * scale).epsilon(1e-3));
    }
}

TEST_CASE("clip planes: as an attribute of a state they are left to OpenGL", "[bridge]")
{
    const auto geometry = triangleGeometry();
    geometry->getOrCreateStateSet()->setAttributeAndModes(
        new osg::ClipPlane(2, 1.0, 0.0, 0.0, -0.5));
    ConversionInput input = inputFor(geometry);
    CHECK(countOf(convertGraph(geometry), "approximated.clip-plane-attribute") == 1);
    input.rasterizesRest = true;
    SceneConverter converter;
    const ConversionResult result = converter.convert(input);
    CHECK(result.scene->instances.empty());
    CHECK(countOf(result, "rasterized.clip-plane-attribute") == 1);
    REQUIRE(result.rasterized);
}
