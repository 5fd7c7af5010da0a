// VertexTangentsTest.cpp - tangents that meshes lack, beside closed forms. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/accel/SurfaceTangents.h"
#include "osgRayTrace/accel/VertexTangents.h"
#include "osgRayTrace/base/Parallel.h"

#include <glm/gtc/constants.hpp>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a tube around z of some sides, with s around it and t along it, indexed or with corners
/// of its own for each triangle.
Mesh tube(int sides, bool indexed, bool mirrored = false)
{
    std::vector<Vec3> positions, normals;
    std::vector<Vec2> uvs;
    std::vector<UVec3> triangles;
    for (int i = 0; i <= sides; ++i)
        for (int k = 0; k < 2; ++k)
        {
            const float angle = 2.0f * glm::pi<float>() * float(i % sides) / float(sides);
            normals.emplace_back(std::cos(angle), std::sin(angle), 0.0f);
            positions.push_back(normals.back() + Vec3(0.0f, 0.0f, 0.5f * float(k)));
            // Mirrored coordinates go to and fro, over seams without other vertices.
            const float s = mirrored ? std::fabs(float(i) - 0.5f * float(sides)) : float(i);
            uvs.emplace_back(s / float(sides), float(k));
        }
    for (uint32_t i = 0; i < uint32_t(sides); ++i)
    {
        triangles.emplace_back(2 * i, 2 * i + 2, 2 * i + 1);
        triangles.emplace_back(2 * i + 1, 2 * i + 2, 2 * i + 3);
    }
    Mesh mesh;
    if (!indexed)
    {
        std::vector<Vec3> p, n;
        std::vector<Vec2> u;
        for (UVec3& t : triangles)
            for (int k = 0; k < 3; ++k)
            {
                p.push_back(positions[t[k]]);
                n.push_back(normals[t[k]]);
                u.push_back(uvs[t[k]]);
                t[k] = uint32_t(p.size() - 1);
            }
        positions = p;
        normals = n;
        uvs = u;
    }
    mesh.positions = std::move(positions);
    mesh.normals = std::move(normals);
    mesh.uvs = std::move(uvs);
    mesh.triangles = std::move(triangles);
    return mesh;
}

Vec4 tangentAt(const VertexTangents& made, std::size_t triangle, int corner)
{
    const uint32_t number = made.triangles.at(triangle)[corner];
    REQUIRE(number < made.tangents.size());
    return made.tangents[number];
}

} // namespace

TEST_CASE("vertex tangents: around a tube they are those of the cylinder", "[accel]")
{
    for (const bool indexed : {true, false})
    {
        const Mesh mesh = tube(12, indexed);
        const VertexTangents made = vertexTangents(mesh, mesh.uvs);
        REQUIRE(made.triangles.size() == mesh.triangles.size());
        // A pair of vertices for each side, and the first pair again at the seam of s.
        CHECK(made.tangents.size() == 26);
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
            for (int k = 0; k < 3; ++k)
            {
                const Vec3 n = mesh.normals[mesh.triangles[i][k]];
                const Vec4 tangent = tangentAt(made, i, k);
                CAPTURE(indexed, i, k);
                CHECK(glm::length(Vec3(tangent) - Vec3(-n.y, n.x, 0.0f)) < 1e-5f);
                CHECK(tangent.w == 1.0f);
            }
    }
}

TEST_CASE("vertex tangents: windings of coordinates part the mean at a mirror seam", "[accel]")
{
    const Mesh mesh = tube(12, true, true);
    const VertexTangents made = vertexTangents(mesh, mesh.uvs);
    int both = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k)
        {
            const Vec3 n = mesh.normals[mesh.triangles[i][k]];
            const Vec4 tangent = tangentAt(made, i, k);
            const float side = i < 12 ? -1.0f : 1.0f; // s falls first, and then grows
            CAPTURE(i, k);
            CHECK(glm::length(Vec3(tangent) - side * Vec3(-n.y, n.x, 0.0f)) < 1e-5f);
            CHECK(tangent.w == side);
            both += mesh.triangles[i][k] == 12; // on the seam
        }
    CHECK(both > 2);
    CHECK(made.triangles[11].y != made.triangles[12].x);
}

TEST_CASE("vertex tangents: triangles count by their angle", "[accel]")
{
    // Around a vertex in the plane z = 0 are triangles of 30 and of 90 degrees. Over the first s
    // grows along x, over the second along y.
    Mesh mesh;
    const float third = std::sqrt(3.0f);
    mesh.positions = std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {third, 1, 0}, {-1, third, 0}};
    mesh.normals = std::vector<Vec3>(4, Vec3(0, 0, 1));
    mesh.uvs = std::vector<Vec2>{{0, 0}, {2, 0}, {third, 1}, {third, 1 + third}};
    mesh.triangles = std::vector<UVec3>{{0, 1, 2}, {0, 2, 3}};
    const VertexTangents made = vertexTangents(mesh, mesh.uvs);
    // Over the second triangle: (sqrt 3, 1) to (sqrt 3, 1) and (-1, sqrt 3) to (sqrt 3, 1 + sqrt
    // 3).
    const Vec2 p(third, 1), q(third, 1 + third);
    const Vec3 b(third, 1, 0), c(-1, third, 0);
    const Vec3 second = glm::normalize(b * q.y - c * p.y);
    const Vec3 expected = glm::normalize(Vec3(1, 0, 0) * 30.0f + second * 90.0f);
    REQUIRE(glm::length(expected - glm::normalize(Vec3(1, 0, 0) + second)) > 0.02f);
    for (const std::size_t triangle : {0, 1})
        CHECK(glm::length(Vec3(tangentAt(made, triangle, 0)) - expected) < 1e-5f);
    CHECK(glm::length(Vec3(tangentAt(made, 0, 1)) - Vec3(1, 0, 0)) < 1e-6f);
    CHECK(glm::length(Vec3(tangentAt(made, 1, 2)) - second) < 1e-5f);
}

TEST_CASE("vertex tangents: triangles without area in the texture take their neighbours'",
          "[accel]")
{
    Mesh mesh;
    mesh.positions = std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {5, 5, 0}};
    mesh.normals = std::vector<Vec3>(5, Vec3(0, 0, 1));
    mesh.uvs = std::vector<Vec2>{{0, 0}, {1, 0}, {0, 1}, {1, 0}, {1, 0}};
    mesh.triangles = std::vector<UVec3>{{0, 1, 2}, {1, 3, 2}, {1, 3, 4}};
    const VertexTangents made = vertexTangents(mesh, mesh.uvs);
    CHECK(Vec3(tangentAt(made, 1, 0)).x > 0.5f);
    CHECK(made.triangles[2].x == made.triangles[0].y);
    CHECK(made.triangles[2].z == kInvalid); // nobody has one there
}

TEST_CASE("vertex tangents: scenes have them where a material needs them, and go on having them",
          "[accel]")
{
    const auto mesh = std::make_shared<Mesh>(tube(12, true));
    Material plain = lambert(Vec3(0.5f)), mapped = plain;
    MaterialDetail detail;
    detail.textures[kNormalRole] = 0;
    mapped.detail = std::make_shared<MaterialDetail>(detail);
    SceneBuilder builder, without;
    auto texel = std::make_shared<Texture>();
    texel->width = texel->height = 1;
    texel->floats = {0.5f, 0.5f, 1.0f, 1.0f};
    builder.scene->textures = {texel};
    builder.add(mesh, mapped);
    without.add(mesh, plain);
    CHECK(without.build()->vertexTangents(0, 0) == nullptr);
    const auto traced = builder.build();
    const VertexTangents* made = traced->vertexTangents(0, 0);
    REQUIRE(made);
    CHECK(traced->vertexTangents(0, 1) == nullptr); // there are no such coordinates

    // Between two vertices the axis is that of the cylinder, where the facet's is that of its
    // middle.
    const Vec3 n = glm::normalize(mesh->normals[0] * 0.75f + mesh->normals[2] * 0.25f);
    const auto axes = surfaceAxes(*traced, {0, 0, 0.25f, 0.0f}, 0, n);
    REQUIRE(axes);
    CHECK(glm::length(axes->tangent - Vec3(-n.y, n.x, 0.0f)) < 1e-5f);
    CHECK(glm::length(axes->bitangent - Vec3(0, 0, 1)) < 1e-5f);
    const auto later = TracedScene::build(builder.scene, std::make_shared<Workers>(), traced);
    CHECK(later->vertexTangents(0, 0) == made);
}
