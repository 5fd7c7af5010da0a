// WatertightTest.cpp - no ray and no light leaves a closed body. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Rays.h"
#include "tests/integrators/Measure.h"

#include "osgRayTrace/accel/Intersector.h"

#include <atomic>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kRows = 200; // each of 400 facets
constexpr std::size_t kBlocks = 62500;

enum class Aim
{
    Random,
    Edge,
    Vertex,
};

Vec3d target(const Mesh& sphere, Aim aim, const Vec3d& eye, Uniform& random)
{
    if (aim == Aim::Random)
    {
        const double z = random.between(-1, 1), phi = random.between(0, 2.0 * M_PI),
                     r = std::sqrt(1.0 - z * z);
        return eye + Vec3d(r * std::cos(phi), r * std::sin(phi), z);
    }
    if (aim == Aim::Vertex)
    {
        // The vertex is any but a pole, of which there are many copies.
        constexpr int kColumns = 2 * kRows;
        return Vec3d(
            sphere.positions[static_cast<std::size_t>(random.between(kColumns, kColumns * kRows))]);
    }
    const UVec3 t = sphere.triangles[static_cast<std::size_t>(
        random.between(0.0, 1.0) * static_cast<double>(sphere.triangles.size()))];
    const int corner = static_cast<int>(3.0f * random());
    const Vec3d a(sphere.positions[t[corner]]), b(sphere.positions[t[(corner + 1) % 3]]);
    return a + (b - a) * double(random());
}

/// Counts which of a million rays from eye miss the sphere.
int64_t escapes(const Mesh& sphere, const TracedScene& traced, const Vec3& eye, Aim aim)
{
    std::atomic<int64_t> count{0};
    Workers().forEach(
        kBlocks,
        [&](std::size_t b)
        {
            Uniform random(static_cast<uint32_t>(b));
            RayHitBlock block = {};
            for (int i = 0; i < kLanes; ++i)
            {
                const Vec3 d(glm::normalize(target(sphere, aim, Vec3d(eye), random) - Vec3d(eye)));
                setRay(block.ray, i, eye, d);
            }
            traced.intersector().closestHits(block, kAllLanes, Coherence::Incoherent);
            int missed = 0;
            for (int i = 0; i < kLanes; ++i)
                missed += block.geometry[i] == kInvalid;
            count += missed;
        });
    return count;
}

} // namespace

TEST_CASE("stability 5: closed sphere, rays at edges and vertices", "[stability]")
{
    // Coordinates are relative to the camera, so its place in the world does not matter, and of its
    // size only the digits matter, not the power of two. One eye is at the centre, where rays meet
    // edges and vertices head on and by symmetry; the other is elsewhere.
    const auto sphere = sphereMesh(Vec3(0.0f), 2.0f, kRows);
    SceneBuilder builder;
    builder.add(sphere, lambert(Vec3(0.5f)));
    const auto traced = builder.build();
    for (const Vec3& eye : {Vec3(0.0f), Vec3(0.7f, -0.4f, 0.9f)})
    {
        CAPTURE(eye.x);
        CHECK(escapes(*sphere, *traced, eye, Aim::Random) == 0);
        CHECK(escapes(*sphere, *traced, eye, Aim::Edge) == 0);
        // Embree's robust test leaves vertices open: 0.78 to 1.8 % of the rays are lost, depending
        // on the place of the eye alone. The same rays are lost in packets, in coherent packets and
        // one by one, in a flat scene and in an instance. 98 % of them hit if they are turned by
        // one ulp. A second try would cost time for all rays that see the background, and rays with
        // such an aim occur in tests only.
        CHECK(escapes(*sphere, *traced, eye, Aim::Vertex) <= 20000);
    }
}

TEST_CASE("stability 6: a furnace far from the origin leaks no light", "[stability][statistics]")
{
    // The radiance is Le / (1 - rho) = 2, and every bounce is alike: light is lost only through
    // cracks or by rays that begin outside. If the vertices are in world coordinates, the loader is
    // to blame for their rounding, and the sphere is still closed.
    const Vec3d centre(148376.0, 1234.0, -223423.0);
    Material wall = lambert(Vec3(0.5f));
    wall.emission = Vec3(1.0f);
    for (const bool baked : {false, true})
    {
        SceneBuilder builder;
        builder.addEmissive(sphereMesh(baked ? Vec3(centre) : Vec3(0.0f), 2.0f, kRows), wall);
        if (!baked) builder.scene->origin = centre;
        const View view =
            perspectiveView(centre, centre + Vec3d(1, 0.2, 0.3), {0, 0, 1}, 80.0, 32, 32);
        const Estimate radiance =
            measure(builder.build(), view, optionsOf(IntegratorKind::Path, 64), 160);
        CAPTURE(baked, radiance.mean(), radiance.standardError());
        CHECK(radiance.standardError() < 5e-4);
        CHECK(radiance.mean() == Approx(2.0).margin(2e-3));
    }
}
