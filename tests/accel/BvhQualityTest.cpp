// BvhQualityTest.cpp - when the BVH of a mesh that deforms is worth another build.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/accel/BvhQuality.h"

#include <random>

using namespace osgRayTrace::engine;

namespace
{

constexpr uint32_t kSide = 40;

/// Returns a square of triangles whose corners are the places that the function gives to the points
/// of a lattice.
template <class Place> Mesh latticeOf(const Place& place)
{
    std::vector<Vec3> positions;
    std::vector<UVec3> triangles;
    for (uint32_t y = 0; y <= kSide; ++y)
        for (uint32_t x = 0; x <= kSide; ++x)
        {
            positions.push_back(place(Vec3(float(x), float(y), 0.0f)));
            if (x == kSide || y == kSide) continue;
            const uint32_t a = y * (kSide + 1) + x, c = a + kSide + 2;
            triangles.push_back({a, a + 1, c});
            triangles.push_back({a, c, c - 1});
        }
    Mesh mesh;
    mesh.positions = std::move(positions);
    mesh.triangles = std::move(triangles);
    return mesh;
}

} // namespace

TEST_CASE("bvh quality: moved and scaled meshes keep theirs, scattered ones do not", "[accel]")
{
    const BvhQuality quality(latticeOf([](Vec3 p) { return p; }));
    const auto degradation = [&](const auto& place)
    { return quality.degradation(latticeOf(place)); };
    CHECK(degradation([](Vec3 p) { return p; }) == 1.0);
    CHECK(degradation([](Vec3 p) { return p * 8.0f + Vec3(64.0f, 0.0f, -16.0f); }) ==
          Approx(1.0).epsilon(1e-5));
    CHECK(degradation([](Vec3 p) { return Vec3(-p.y, p.z, p.x); }) == Approx(1.0).epsilon(1e-5));
    const double waves =
        degradation([](Vec3 p) { return p + Vec3(0.0f, 0.0f, std::sin(0.2f * p.x)); });
    CHECK(waves < kDegraded);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(0.0f, float(kSide));
    CHECK(degradation([&](Vec3) { return Vec3(uniform(random), uniform(random), 0.0f); }) > 10.0);
    CHECK(degradation([](Vec3) { return Vec3(1.0f); }) < kDegraded);
}

TEST_CASE("bvh quality: a mesh that was a point or a line when it was built is built again",
          "[accel]")
{
    const Mesh square = latticeOf([](Vec3 p) { return p; });
    const Mesh point = latticeOf([](Vec3) { return Vec3(3.0f); });
    const Mesh line = latticeOf([](Vec3 p) { return Vec3(p.x + p.y, 0.0f, 0.0f); });
    for (const Mesh& mesh : {point, line})
    {
        const BvhQuality quality(mesh);
        CHECK(quality.degradation(square) > kDegraded);
        CHECK(quality.degradation(mesh) == 1.0);
        CHECK(quality.degradation(point) == 1.0);
    }
}
