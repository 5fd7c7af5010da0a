// SurfaceTest.cpp - surface points lie on their triangles and have their attributes.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Rays.h"
#include "tests/Statistics.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/accel/SurfaceAttributes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("surface: both sides, normals and attributes", "[accel]")
{
    auto mesh = quadMesh({0, 0, 0}, {2, 0, 0}, {0, 2, 0});
    mesh->uvs = std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh->colors = std::vector<Vec4>{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}};
    const Vec3 tilted = glm::normalize(Vec3(0.3f, 0, 1));
    mesh->normals = std::vector<Vec3>(4, tilted);
    SceneBuilder builder;
    const uint32_t index = builder.add(mesh, lambert(Vec3(0.5f)));
    const auto traced = builder.build();
    for (const float side : {1.0f, -1.0f})
    {
        RayHitBlock block;
        for (int i = 0; i < kLanes; ++i)
            setRay(block.ray, i, Vec3(1.5f, 0.5f, 3.0f * side), Vec3(0, 0, -side));
        setRay(block.ray, 3, Vec3(7, 7, 3), Vec3(0, 0, -side));
        traced->intersector().closestHits(block, kAllLanes, Coherence::Coherent);
        SurfaceLanes surface;
        surfacesOf(traced->surfaces(), block, kAllLanes & ~1u, surface);
        CHECK(surface.hits == (kAllLanes & ~1u & ~(1u << 3)));
        CHECK((surface.front & surface.hits) == (side > 0.0f ? surface.hits : 0u));
        CHECK(laneOf(surface.geometricNormal, 5) == Vec3(0, 0, side));
        CHECK(glm::length(laneOf(surface.shadingNormal, 5) - tilted) < 1e-6f); // as the mesh has it
        CHECK(glm::length(laneOf(surface.position, 5) - Vec3(1.5f, 0.5f, 0)) < 1e-6f);
        CHECK(surface.instance[5] == index);
        CHECK(surface.material[5] == traced->scene().instances[index].material);
        const SurfaceRecord& record = traced->surfaces()[index];
        const Vec2 uv = interpolateUv(record, block.primitive[5], block.u[5], block.v[5]);
        CHECK(uv.x == Approx(0.75));
        CHECK(uv.y == Approx(0.25));
        const Vec4 color = interpolateColor(record, block.primitive[5], block.u[5], block.v[5]);
        CHECK(color.x == Approx(0.25));
        CHECK(color.y == Approx(0.5));
        CHECK(color.z == Approx(0.25));
    }
}

TEST_CASE("surface: attributes that a mesh lacks have defaults", "[accel]")
{
    SceneBuilder builder;
    builder.add(quadMesh({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(0.5f)));
    const auto traced = builder.build();
    CHECK(interpolateUv(traced->surfaces()[0], 0, 0.3f, 0.3f) == Vec2(0.0f));
    CHECK(interpolateColor(traced->surfaces()[0], 0, 0.3f, 0.3f) == Vec4(1.0f));
}

TEST_CASE("surface: vertex normals that cancel, or are zero, leave the geometric one",
          "[accel][stability 54]")
{
    auto mesh = newMesh({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}});
    for (const auto& normals :
         {std::vector<Vec3>(3, Vec3(0.0f)), std::vector<Vec3>{{1, 0, 0}, {-1, 0, 0}, {0, 0, 0}}})
    {
        mesh->normals = std::vector<Vec3>(normals);
        SceneBuilder builder;
        builder.add(mesh, lambert(Vec3(0.5f)));
        const auto traced = builder.build();
        RayHitBlock block;
        for (int i = 0; i < kLanes; ++i)
            setRay(block.ray, i, Vec3(0, -0.999f, 1), Vec3(0, 0, -1));
        traced->intersector().closestHits(block, kAllLanes, Coherence::Coherent);
        SurfaceLanes surface;
        surfacesOf(traced->surfaces(), block, kAllLanes, surface);
        const Vec3 n = laneOf(surface.shadingNormal, 0);
        CHECK(isFinite(n));
        CHECK(glm::length(n) == Approx(1.0f));
    }
}

TEST_CASE("surface: normals of instances by the inverse transpose, facing by the winding seen",
          "[accel]")
{
    auto mesh = quadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 1});
    mesh->normals = std::vector<Vec3>(4, glm::normalize(Vec3(0, -1, 1)));
    for (const float mirror : {1.0f, -1.0f})
    {
        SceneBuilder builder;
        const uint32_t index = builder.add(mesh, lambert(Vec3(0.5f)));
        Instance& instance = builder.scene->instances[index];
        instance.placed = true;
        instance.mirrored = mirror < 0.0f;
        instance.engineFromLocal.linear = Mat3(mirror, 0, 0, 0, 1, 0, 0, 0, 4);
        const auto traced = builder.build();
        RayHitBlock block;
        for (int i = 0; i < kLanes; ++i)
            setRay(block.ray, i, Vec3(0.5f * mirror, 0.5f, 9), Vec3(0, 0, -1));
        traced->intersector().closestHits(block, kAllLanes, Coherence::Coherent);
        SurfaceLanes surface;
        surfacesOf(traced->surfaces(), block, kAllLanes, surface);
        REQUIRE(surface.hits == kAllLanes);
        const Vec3 expected = glm::normalize(Vec3(0, -4, 1));
        // The shading normals of flat meshes point outwards, too.
        Mesh flat = *mesh;
        flat.normals = {};
        builder.scene->meshes[0] = std::make_shared<Mesh>(flat);
        const auto flatTraced = builder.build();
        SurfaceLanes flatSurface;
        surfacesOf(flatTraced->surfaces(), block, kAllLanes, flatSurface);
        CHECK(glm::length(laneOf(flatSurface.shadingNormal, 2) - expected) < 1e-5f);
        CAPTURE(mirror);
        CHECK(glm::length(laneOf(surface.geometricNormal, 2) - expected) < 1e-5f);
        CHECK(glm::length(laneOf(surface.shadingNormal, 2) - expected) < 1e-5f);
        // The outside of a mirrored body is still its outside.
        CHECK((surface.front & 4u) == 4u);
    }
}

TEST_CASE("surface: blocks that follow on others on the same triangle are as they are alone",
          "[accel]")
{
    // The triangles of four bodies have the same number. The blocks come in any order: each body
    // follows on itself, on all others, on a block without hits and on a block on two bodies.
    const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.25f}};
    auto flat = newMesh(corners, {{0, 1, 2}}), smooth = newMesh(corners, {{0, 1, 2}});
    smooth->normals = std::vector<Vec3>{{-0.3f, -0.3f, 1}, {0.3f, 0, 1}, {0, 0.3f, 1}};
    SceneBuilder builder;
    for (int body = 0; body < 4; ++body)
    {
        const float grey = 0.2f * static_cast<float>(1 + body);
        Instance& instance =
            builder.scene->instances[builder.add(body % 2 ? smooth : flat, lambert(Vec3(grey)))];
        instance.placed = true;
        instance.mirrored = body > 1;
        instance.engineFromLocal.linear = Mat3(body > 1 ? -1 : 1, 0, 0, 0, 1, 0, 0, 0, 1);
        instance.engineFromLocal.translation = Vec3(3 * body, 0, 0);
    }
    const auto traced = builder.build();
    Uniform random(7);
    const auto target = [&](int body)
    {
        const double u = 0.1 + 0.3 * random(), v = 0.1 + 0.3 * random();
        return Vec3(Vec3d(3 * body + (body > 1 ? -u : u), v, 9)); // body 4 does not exist: a miss
    };
    LastTriangle last;
    int reused = 0;
    for (int k = 0; k < 400; ++k)
    {
        const int body = static_cast<int>(random() * 6), other = body == 5 ? 1 : body;
        RayHitBlock block;
        for (int i = 0; i < kLanes; ++i)
            setRay(block.ray, i, target(i % 3 ? body % 5 : other), Vec3(0, 0, -1));
        traced->intersector().closestHits(block, kAllLanes, Coherence::Coherent);
        SurfaceLanes alone, surface;
        surfacesOf(traced->surfaces(), block, kAllLanes, alone, RayStart::Smooth);
        reused +=
            alone.hits && block.geometry[0] == last.geometry && block.instance[0] == last.instance;
        surfacesOf(traced->surfaces(), block, kAllLanes, surface, RayStart::Smooth, &last);
        CAPTURE(k, body);
        REQUIRE(surface.hits == (body == 4 ? 0u : kAllLanes));
        REQUIRE(surface.hits == alone.hits);
        REQUIRE((surface.front & surface.hits) == (alone.front & alone.hits));
        REQUIRE(surface.terminatorLanes == alone.terminatorLanes);
        for (int i = 0; i < kLanes; ++i)
        {
            if (!((surface.hits >> i) & 1u)) continue;
            REQUIRE(laneOf(surface.position, i) == laneOf(alone.position, i));
            REQUIRE(laneOf(surface.geometricNormal, i) == laneOf(alone.geometricNormal, i));
            REQUIRE(laneOf(surface.shadingNormal, i) == laneOf(alone.shadingNormal, i));
            REQUIRE(surface.offset[i] == alone.offset[i]);
            REQUIRE(surface.minCosine[i] == alone.minCosine[i]);
            REQUIRE(surface.instance[i] == alone.instance[i]);
            REQUIRE(surface.material[i] == alone.material[i]);
        }
    }
    CHECK(reused > 40);
}

TEST_CASE("surface: textures are generated by the normals that light falls on", "[accel]")
{
    // The transform lengthens some of the vertex normals; all of them must keep their weight.
    auto mesh = quadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    mesh->normals = std::vector<Vec3>{
        {0, 0, 1}, glm::normalize(Vec3(1, 0, 1)), {0.6f, 0, 0.8f}, glm::normalize(Vec3(0, -1, 2))};
    SceneBuilder builder;
    Instance& instance = builder.scene->instances[builder.add(mesh, lambert(Vec3(0.5f)))];
    instance.placed = true;
    instance.engineFromLocal.linear = Mat3(1, 0, 0, 0, 2, 0, 0, 0, 9);
    instance.engineFromLocal.translation = Vec3(0, 0, -3);
    const auto traced = builder.build();
    RayHitBlock block;
    for (int i = 0; i < kLanes; ++i)
        setRay(block.ray, i, Vec3(0.05f + 0.06f * float(i), 0.7f, 9), Vec3(0, 0, -1));
    traced->intersector().closestHits(block, kAllLanes, Coherence::Coherent);
    SurfaceLanes surface;
    surfacesOf(traced->surfaces(), block, kAllLanes, surface);
    REQUIRE(surface.hits == kAllLanes);
    MaterialRecord generated;
    generated.generated = true;
    for (int i = 0; i < kLanes; ++i)
    {
        const MaterialPoint point =
            materialPointOf(traced->surfaces()[0], generated, block.primitive[i], block.u[i],
                            block.v[i], true, Vec3(0, 0, -1));
        CAPTURE(i);
        CHECK(glm::length(point.normal - laneOf(surface.shadingNormal, i)) < 1e-5f);
        CHECK(glm::length(point.position - laneOf(surface.position, i)) < 1e-5f);
    }
}
