// SurfaceRaysTest.cpp - rays that leave a surface do not hit it, and find what is close to it.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Rays.h"
#include "tests/Statistics.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/Surface.h"

#include <atomic>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

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
                    const Vec3 n = laneOf(surface.geometricNormal, i);
                    const float side = glm::dot(d, n) >= 0.0f ? 1.0f : -1.0f;
                    setRay(next.ray, i,
                           laneOf(surface.position, i) + n * (side * surface.offset[i]), d);
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
                        std::abs(glm::dot(d, Vec3d(laneOf(surface.geometricNormal, i)))) > 1e-5;
                }
            }
            for (int i = 0; i < kLanes; ++i)
            {
                if (!((surface.hits >> i) & 1u)) continue;
                const UVec3 t = triangles[block.primitive[i]];
                const Vec3d a(positions[t.x]), ab = Vec3d(positions[t.y]) - a,
                                               ac = Vec3d(positions[t.z]) - a;
                const Vec3d n = glm::normalize(glm::cross(ab, ac));
                const double distance =
                    std::abs(glm::dot(Vec3d(laneOf(surface.position, i)) - a, n));
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
            const Vec3 n = laneOf(surface.geometricNormal, 0);
            const float side = glm::dot(Vec3(d), n) >= 0.0f ? 1.0f : -1.0f;
            selfHits += traced->intersector().occluded(laneOf(surface.position, 0) +
                                                           n * (side * surface.offset[0]),
                                                       Vec3(d), 0.0f, kInfinity);
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
            const Vec3 origin = laneOf(surface.position, 0) +
                                laneOf(surface.geometricNormal, 0) * surface.offset[0];
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
            const Vec3 terminatorOffset =
                laneOf(surface.position, 7) - laneOf(trianglePoints(surface), 7);
            CHECK(glm::length(terminatorOffset) == Approx(0.25f * edge * edge).epsilon(0.02));
            CHECK(glm::dot(terminatorOffset, n) > 0.0f);
            dropTerminatorOffset(surface, 3u);
            CHECK(surface.terminatorLanes == (kAllLanes & ~3u));
            CHECK(laneOf(surface.position, 1) == laneOf(trianglePoints(surface), 1));
            CHECK(laneOf(surface.position, 2) != laneOf(trianglePoints(surface), 2));
            surfacesOf(traced->surfaces(), block, kAllLanes, surface);
            CHECK(surface.terminatorLanes == 0u);
            CHECK(glm::length(laneOf(surface.position, 7) - middle) < 1e-6f);
        }
    }
}

TEST_CASE("surface: terminator offsets are the same in blocks of one triangle and of several, "
          "placed or not",
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
        return laneOf(surface.position, 0);
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
