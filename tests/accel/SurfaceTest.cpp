// SurfaceTest.cpp - surface points lie on their triangles, and rays that leave them do not hit
// them.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Rays.h"
#include "tests/Statistics.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/accel/SurfaceAttributes.h"

#include <atomic>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Vec3 at(const Vec3Lanes& lanes, int i)
{
    return Vec3(lanes.x[i], lanes.y[i], lanes.z[i]);
}

Vec3d randomDirection(Uniform& random)
{
    const double z = random.between(-1, 1), phi = random.between(0, 2.0 * M_PI),
                 r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

struct Spawned
{
    int64_t rays = 0, selfHits = 0, offPlane = 0;
    int64_t steepSelfHits = 0; ///< of rays more than 1e-5 off the tangent plane
};

/// Hits the triangles of a random mesh, and sends rays from the hit points to both sides.
Spawned spawn(double smallest, double largest, Vec3d translation, int blocks, uint32_t seed)
{
    Uniform random(seed);
    constexpr uint32_t kTriangles = 200;
    std::vector<Vec3> positions;
    std::vector<UVec3> triangles;
    for (uint32_t t = 0; t < kTriangles; ++t)
    {
        const double size = smallest * std::pow(largest / smallest, random());
        for (int corner = 0; corner < 3; ++corner)
            positions.emplace_back(translation + size * Vec3d(random.between(-1, 1),
                                                              random.between(-1, 1),
                                                              random.between(-1, 1)));
        triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    }
    SceneBuilder builder;
    builder.add(newMesh(positions, triangles), lambert(Vec3(0.5f)));
    const auto traced = builder.build();
    const Intersector& intersector = traced->intersector();

    std::atomic<int64_t> rays{0}, selfHits{0}, offPlane{0}, steepSelfHits{0};
    Workers().forEach(
        static_cast<std::size_t>(blocks),
        [&](std::size_t b)
        {
            Uniform own(seed + 1 + static_cast<uint32_t>(b));
            RayHitBlock block;
            for (int i = 0; i < kLanes; ++i)
            {
                const auto t = static_cast<std::size_t>(own() * kTriangles);
                const Vec3d p0(positions[3 * t]), p1(positions[3 * t + 1]),
                    p2(positions[3 * t + 2]);
                double u = own(), v = own();
                if (u + v > 1.0)
                {
                    u = 1.0 - u;
                    v = 1.0 - v;
                }
                const Vec3d target = p0 + u * (p1 - p0) + v * (p2 - p0);
                const Vec3d d = randomDirection(own);
                setRay(block.ray, i, Vec3(target - d * (2.0 * glm::length(p1 - p0))), Vec3(d));
            }
            intersector.closestHits(block, kAllLanes, Coherence::Incoherent);
            SurfaceLanes surface;
            surfacesOf(traced->surfaces(), block, kAllLanes, surface);
            for (int repeat = 0; repeat < 16; ++repeat)
            {
                RayHitBlock next;
                for (int i = 0; i < kLanes; ++i)
                {
                    const Vec3 d(randomDirection(own));
                    const Vec3 n = at(surface.geometricNormal, i);
                    const float side = glm::dot(d, n) >= 0.0f ? 1.0f : -1.0f;
                    setRay(next.ray, i, at(surface.position, i) + n * (side * surface.offset[i]),
                           d);
                }
                intersector.closestHits(next, surface.hits, Coherence::Incoherent);
                for (int i = 0; i < kLanes; ++i)
                {
                    if (!((surface.hits >> i) & 1u)) continue;
                    ++rays;
                    if (next.geometry[i] == kInvalid || next.primitive[i] != block.primitive[i])
                        continue;
                    ++selfHits;
                    const Vec3d d(next.ray.directionX[i], next.ray.directionY[i],
                                  next.ray.directionZ[i]);
                    steepSelfHits +=
                        std::abs(glm::dot(d, Vec3d(at(surface.geometricNormal, i)))) > 1e-5;
                }
            }
            for (int i = 0; i < kLanes; ++i)
            {
                if (!((surface.hits >> i) & 1u)) continue;
                const UVec3 t = triangles[block.primitive[i]];
                const Vec3d a(positions[t.x]), ab = Vec3d(positions[t.y]) - a,
                                               ac = Vec3d(positions[t.z]) - a;
                const Vec3d n = glm::normalize(glm::cross(ab, ac));
                const double distance = std::abs(glm::dot(Vec3d(at(surface.position, i)) - a, n));
                offPlane += distance > surface.offset[i];
            }
        });
    return {rays, selfHits, offPlane, steepSelfHits};
}

} // namespace

TEST_CASE("surface: rays from it do not hit it again", "[accel][statistics][stability 8]")
{
    // The test sends two million rays with coordinates of 1e-3 to 1e4 around the origin. At most
    // 2e-6 of them may hit their own surface: those within 1e-6 of the tangent plane. On translated
    // scenes no ray may do so.
    const Spawned origin = spawn(1e-3, 1e4, Vec3d(0.0), 10000, 1);
    CHECK(origin.rays > 2000000);
    CHECK(origin.selfHits <= static_cast<int64_t>(2e-6 * static_cast<double>(origin.rays)));
    CHECK(origin.steepSelfHits == 0);
    CHECK(origin.offPlane == 0);
    for (const double translation : {1e3, 1e5})
    {
        const Spawned moved =
            spawn(1.0, 10.0, Vec3d(translation, -translation, 0.5 * translation), 1500, 2);
        CAPTURE(translation);
        CHECK(moved.rays > 200000);
        CHECK(moved.selfHits == 0);
        CHECK(moved.offPlane == 0);
    }
}

TEST_CASE("surface: planes through the origin have an offset, too", "[accel]")
{
    // All coordinates along the normal are 0.
    for (const float size : {1e-3f, 1.0f, 1e4f})
    {
        SceneBuilder builder;
        builder.add(quadMesh({-size, -size, 0}, {2 * size, 0, 0}, {0, 2 * size, 0}),
                    lambert(Vec3(0.5f)));
        const auto traced = builder.build();
        Uniform random(3);
        int selfHits = 0;
        for (int k = 0; k < 20000; ++k)
        {
            RayHitBlock block;
            for (int i = 0; i < kLanes; ++i)
                setRay(block.ray, i, Vec3(0, 0, size),
                       Vec3(glm::normalize(
                           Vec3d(random.between(-0.5, 0.5), random.between(-0.5, 0.5), -1.0))));
            traced->intersector().closestHits(block, kAllLanes, Coherence::Coherent);
            SurfaceLanes surface;
            surfacesOf(traced->surfaces(), block, kAllLanes, surface);
            const Vec3d d = randomDirection(random);
            const Vec3 n = at(surface.geometricNormal, 0);
            const float side = glm::dot(Vec3(d), n) >= 0.0f ? 1.0f : -1.0f;
            selfHits += traced->intersector().occluded(
                at(surface.position, 0) + n * (side * surface.offset[0]), Vec3(d), 0.0f, kInfinity);
        }
        CAPTURE(size);
        CHECK(selfHits == 0);
    }
}

TEST_CASE("surface: an occluder at four times the error bound is found", "[accel][stability 9]")
{
    for (const double translation : {0.0, 1.0, 1e3, 1e5})
    {
        for (const float size : {0.01f, 1.0f, 100.0f})
        {
            const Vec3 corner(static_cast<float>(translation) - 0.5f * size, -0.5f * size,
                              static_cast<float>(translation));
            SceneBuilder floor;
            floor.add(quadMesh(corner, {size, 0, 0}, {0, size, 0}), lambert(Vec3(0.5f)));
            const auto surfaceAt = [](const TracedScene& traced, Vec3 origin)
            {
                RayHitBlock block;
                for (int i = 0; i < kLanes; ++i)
                    setRay(block.ray, i, origin, Vec3(0, 0, -1));
                traced.intersector().closestHits(block, 1u, Coherence::Incoherent);
                SurfaceLanes surface;
                surfacesOf(traced.surfaces(), block, 1u, surface);
                return surface;
            };
            const Vec3 above = corner + Vec3(0.4f * size, 0.45f * size, size);
            const SurfaceLanes surface = surfaceAt(*floor.build(), above);
            REQUIRE(surface.hits == 1u);
            const float gap = 4.0f * surface.offset[0];
            floor.add(quadMesh(corner + Vec3(-gap, -gap, gap), {size + 2 * gap, 0, 0},
                               {0, size + 2 * gap, 0}),
                      lambert(Vec3(0.5f)));
            const auto both = floor.build();
            const Vec3 origin =
                at(surface.position, 0) + at(surface.geometricNormal, 0) * surface.offset[0];
            CAPTURE(translation, size, gap);
            CHECK(both->intersector().occluded(origin, Vec3(0, 0, 1), 0.0f, kInfinity));
            CHECK(both->intersector().occluded(origin, glm::normalize(Vec3(0.5f, 0, 1)), 0.0f,
                                               kInfinity));
            // The offset is small beside the body: 1e-5 of its size or of its distance to the
            // origin.
            CHECK(surface.offset[0] < 1e-5 * std::max(double(size), translation));
        }
    }
}

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
        CHECK(at(surface.geometricNormal, 5) == Vec3(0, 0, side));
        CHECK(glm::length(at(surface.shadingNormal, 5) - tilted) < 1e-6f); // as the mesh has it
        CHECK(glm::length(at(surface.position, 5) - Vec3(1.5f, 0.5f, 0)) < 1e-6f);
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
        const Vec3 n = at(surface.shadingNormal, 0);
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
        CHECK(glm::length(at(flatSurface.shadingNormal, 2) - expected) < 1e-5f);
        CAPTURE(mirror);
        CHECK(glm::length(at(surface.geometricNormal, 2) - expected) < 1e-5f);
        CHECK(glm::length(at(surface.shadingNormal, 2) - expected) < 1e-5f);
        // The outside of a mirrored body is still its outside.
        CHECK((surface.front & 4u) == 4u);
    }
}

TEST_CASE("surface: rays of a smooth facet start on the tangent planes of its vertices", "[accel]")
{
    // This is a facet of the unit sphere: the middle of an edge of length L is L^2/4 from the
    // tangent planes of its ends, twice its depth below the sphere. Normals need not be unit
    // vectors, and may point to either side.
    const Vec3 a(0, 0, 1), b(std::sin(0.4f), 0, std::cos(0.4f)),
        c = glm::normalize(Vec3(0.2f, 0.4f, 1.0f));
    const float edge = glm::length(b - a);
    for (const float length : {1.0f, -2.5f})
    {
        for (const float side : {1.0f, -1.0f})
        {
            auto mesh = newMesh({a, b, c}, {{0, 1, 2}});
            mesh->normals = std::vector<Vec3>{a * length, b * length, c * length};
            SceneBuilder builder;
            builder.add(mesh, lambert(Vec3(0.5f)));
            const auto traced = builder.build();
            const Vec3 middle = 0.4995f * (a + b) + 0.001f * c;
            const Vec3 n = glm::normalize(glm::cross(b - a, c - a));
            RayHitBlock block;
            for (int i = 0; i < kLanes; ++i)
                setRay(block.ray, i, middle + n * side, n * -side);
            traced->intersector().closestHits(block, kAllLanes, Coherence::Coherent);
            SurfaceLanes surface;
            surfacesOf(traced->surfaces(), block, kAllLanes, surface, RayStart::Smooth);
            REQUIRE(surface.hits == kAllLanes);
            CAPTURE(length, side);
            if (side < 0.0f) // hollow
            {
                CHECK(surface.terminatorLanes == 0u);
                CHECK(&trianglePoints(surface) == &surface.position);
                continue;
            }
            CHECK(surface.terminatorLanes == kAllLanes);
            const Vec3 terminatorOffset = at(surface.position, 7) - at(trianglePoints(surface), 7);
            CHECK(glm::length(terminatorOffset) == Approx(0.25f * edge * edge).epsilon(0.02));
            CHECK(glm::dot(terminatorOffset, n) > 0.0f);
            dropTerminatorOffset(surface, 3u);
            CHECK(surface.terminatorLanes == (kAllLanes & ~3u));
            CHECK(at(surface.position, 1) == at(trianglePoints(surface), 1));
            CHECK(at(surface.position, 2) != at(trianglePoints(surface), 2));
            surfacesOf(traced->surfaces(), block, kAllLanes, surface);
            CHECK(surface.terminatorLanes == 0u);
            CHECK(glm::length(at(surface.position, 7) - middle) < 1e-6f);
        }
    }
}

TEST_CASE("surface: lifts are the same in blocks of one triangle and of several, placed or not",
          "[accel]")
{
    auto mesh = sphereMesh(Vec3(0.0f), 1.0f, 6);
    mesh->normals = std::vector<Vec3>(mesh->positions.begin(), mesh->positions.end());
    const auto startFrom = [&](bool placed, float mirror, bool mixed)
    {
        SceneBuilder builder;
        Instance& instance = builder.scene->instances[builder.add(mesh, lambert(Vec3(0.5f)))];
        instance.placed = placed;
        instance.mirrored = mirror < 0.0f;
        instance.engineFromLocal.linear = Mat3(mirror, 0, 0, 0, 1, 0, 0, 0, 1);
        const auto traced = builder.build();
        RayHitBlock block;
        for (int i = 0; i < kLanes; ++i)
            setRay(block.ray, i, Vec3(mirror * 0.3f, mixed && i > 0 ? -0.6f : 0.2f, 3),
                   Vec3(0, 0, -1));
        traced->intersector().closestHits(block, kAllLanes, Coherence::Coherent);
        SurfaceLanes surface;
        surfacesOf(traced->surfaces(), block, kAllLanes, surface, RayStart::Smooth);
        REQUIRE((surface.terminatorLanes & 1u) == 1u);
        return at(surface.position, 0);
    };
    const Vec3 start = startFrom(false, 1.0f, false);
    CHECK(glm::length(start) > 1.0f);
    CHECK(glm::length(start) < 1.1f);
    for (const bool mixed : {false, true})
    {
        CHECK(glm::length(startFrom(false, 1.0f, mixed) - start) < 1e-6f);
        CHECK(glm::length(startFrom(true, 1.0f, mixed) - start) < 1e-6f);
        CHECK(glm::length(startFrom(true, -1.0f, mixed) - start * Vec3(-1, 1, 1)) < 1e-6f);
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
            REQUIRE(at(surface.position, i) == at(alone.position, i));
            REQUIRE(at(surface.geometricNormal, i) == at(alone.geometricNormal, i));
            REQUIRE(at(surface.shadingNormal, i) == at(alone.shadingNormal, i));
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
        CHECK(glm::length(point.normal - at(surface.shadingNormal, i)) < 1e-5f);
        CHECK(glm::length(point.position - at(surface.position, i)) < 1e-5f);
    }
}
