// VolumeFlightsTest.cpp - flights through volumes compared with closed forms.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/GridMarch.h"
#include "osgRayTrace/media/GridRay.h"

#include "tests/integrators/FlightMeans.h"
#include "tests/integrators/VolumeScenes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns the density at x of the voxels of ramp(n) in the unit cube, far from its other faces.
double rampAt(int n, double x)
{
    if (x < 0.0 || x > 1.0) return 0.0;
    const auto value = [n](int i) { return i < 0 || i >= n ? 0.0 : (i + 0.5) / n; };
    const double at = x * n - 0.5;
    const int i = static_cast<int>(std::floor(at));
    return value(i) + (at - i) * (value(i + 1) - value(i));
}

} // namespace

TEST_CASE("volumes: flights have the transmittance of closed forms, in all channels",
          "[integrators][statistics][volumes]")
{
    const Vec3 sigma(0.4f, 1.5f, 4.0f);
    Scene scene;
    Medium medium;
    medium.sigmaS = sigma;
    scene.volumes.push_back(densityIn({0, 0, 0}, {1, 1, 1}, ramp(40), medium));
    // One dense voxel far from the ray raises the majorant of no block that the ray crosses, and
    // one beside it raises the majorant of its own.
    const GridTable table(scene, nullptr, nullptr, nullptr);
    const GridRay ray(table, {-1, 0.5f, 0.5f}, {1, 0, 0}, 0.0f, 9.0f);
    Medium air = mediumOf(0.3f, 1.0f);
    SceneBuilder around;
    setAtmosphere(around, air, 50.0f);
    const MediumTable media(*around.scene, Vec3(-1.0f), Vec3(1.0f));
    for (const bool inAir : {false, true})
    {
        GridRay filled = ray;
        if (inAir) filled.setAround(media[kOutside], {0.5f, 3.0f});
        const auto [left, collided, ways, shadows] = flightMeans(filled, 9.0f);
        for (std::size_t c = 0; c < 3; ++c)
        {
            const double depth = double(sigma[int(c)]) * rampDepth(40) + (inAir ? 0.3 * 2.5 : 0.0);
            const double expected = std::exp(-depth);
            CAPTURE(inAir, c, expected, left[c].mean(), ways[c].mean(), shadows[c].mean());
            CHECK(left[c].agrees(expected));
            CHECK(collided[c].agrees(1.0 - expected));
            CHECK(ways[c].agrees(expected));
            CHECK(shadows[c].agrees(expected));
            CHECK(left[c].standardError() < 0.01);
        }
    }
}

TEST_CASE("volumes: tentative collisions integrate over all that is within reach",
          "[integrators][statistics][volumes]")
{
    const Vec3 sigma(0.4f, 1.5f, 4.0f);
    const float reach = 0.25f;
    Scene scene;
    Medium medium;
    medium.sigmaS = sigma;
    scene.volumes.push_back(densityIn({0, 0, 0}, {1, 2, 4}, ramp(40), medium));
    const GridTable table(scene, nullptr, nullptr, nullptr);
    std::vector<TentativeCollision> found;
    for (const float side : {0.0f, 1.2f}) // through the middle, and past a face
    {
        GridRay ray(table, {-1, 1 + side, 2}, {1, 0, 0}, 0.0f, 9.0f);
        ray.setReach(reach, {0.0f, 9.0f});
        REQUIRE(ray.isReached());
        std::array<Estimate, 3> lengths, distances;
        for (uint32_t k = 0; k < 40000; ++k)
        {
            NumberStream numbers(hash(k, 4u));
            found.clear();
            ray.flight(Vec3(0.5f, 0.3f, 0.2f), numbers, &found);
            Vec3 length(0.0f), distance(0.0f);
            for (const TentativeCollision& collision : found)
            {
                REQUIRE(collision.distance >= 1.0f - reach);
                REQUIRE(collision.distance <= 2.0f + reach);
                length += collision.weight;
                distance += collision.weight * collision.distance;
            }
            for (std::size_t c = 0; c < 3; ++c)
            {
                lengths[c].add(double(length[int(c)]));
                distances[c].add(double(distance[int(c)]));
            }
        }
        for (std::size_t c = 0; c < 3; ++c)
        {
            constexpr int kSteps = 15000;
            const double step = (1.0 + 2.0 * double(reach)) / kSteps;
            double depth = 0.0, length = 0.0, distance = 0.0;
            for (int i = 0; i < kSteps; ++i)
            {
                const double t = 1.0 - double(reach) + (i + 0.5) * step;
                const double here = side > 0.0f ? 0.0 : double(sigma[int(c)]) * rampAt(40, t - 1.0);
                const double left = std::exp(-depth - 0.5 * here * step);
                depth += here * step;
                length += left * step;
                distance += left * t * step;
            }
            CAPTURE(side, c, length, lengths[c].mean(), distance, distances[c].mean());
            CHECK(lengths[c].agrees(length, 1e-5));
            CHECK(distances[c].agrees(distance, 1e-5));
            CHECK(lengths[c].standardError() < 0.005 * length);
        }
    }
    GridRay past(table, {-1, 2.3f, 2}, {1, 0, 0}, 0.0f, 9.0f);
    past.setReach(reach, {0.0f, 9.0f});
    CHECK_FALSE(past.isReached());
}

TEST_CASE("volumes: steps through empty blocks change no bit of what a ray sees",
          "[integrators][volumes]")
{
    // A few balls in a volume of unequal sides, so that most blocks are empty.
    const auto balls = newVolumeImage(
        61, 24, 40,
        [](int x, int y, int z)
        {
            float most = 0.0f;
            for (const Vec3& center : {Vec3(9, 8, 9), Vec3(50, 17, 31), Vec3(30, 3, 20)})
                most = std::max(most, 1.0f - glm::length(Vec3(Vec3d(x, y, z)) - center) / 6.0f);
            return most;
        });
    Scene scene;
    scene.volumes.push_back(densityIn({0, 0, 0}, {3, 1, 2}, balls, {}));
    scene.volumes[0].law = VolumeLaw::Cells;
    scene.volumes[0].cutoff = 0.05f;
    const GridTable table(scene, nullptr, nullptr, nullptr);
    GridBlocks full = *table[0].blocks;
    CHECK(std::count(full.most.begin(), full.most.end(), 0.0f) >
          std::ptrdiff_t(full.most.size()) / 2);
    std::fill(full.most.begin(), full.most.end(), 1.0f);
    GridRecord whole = table[0];
    whole.blocks = std::make_shared<const GridBlocks>(full);
    Uniform random(17);
    int seen = 0;
    for (int i = 0; i < 4000; ++i)
    {
        const Vec3 origin(random.between(-2, 5), random.between(-2, 3), random.between(-2, 4));
        const Vec3 inside(random.between(0, 3), random.between(0, 1), random.between(0, 2));
        Vec3 direction = glm::normalize(inside - origin);
        if (i % 4 == 0) direction = Vec3(1.0f, 0.0f, 0.0f);
        const MarchedVolume a = march(table[0], origin, direction, 0.0f, 20.0f, {});
        const MarchedVolume b = march(whole, origin, direction, 0.0f, 20.0f, {});
        if (a.color != b.color || a.opacity != b.opacity) FAIL("ray " << i);
        seen += a.opacity > 0.0f;
    }
    CHECK(seen > 400);
}
