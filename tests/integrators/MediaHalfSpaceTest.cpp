// MediaHalfSpaceTest.cpp - what a half-space of a medium gives back, and how near to where it came.
// SPDX-License-Identifier: MIT
#include "tests/integrators/MediaScenes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr float kPi = 3.14159265f;

/// Adds a slab that is so thick that nothing comes through, below a sky that is white.
void addHalfSpace(SceneBuilder& builder, const Medium& medium, float ior)
{
    builder.add(boxMesh({-60, -60, -60}, {60, 60, 0}), bodyOf(medium, ior));
    addHalfSky(builder, true);
}

/// Returns a plate just above the slab, which has a hole of the area of a circle.
std::shared_ptr<Mesh> plateWithHole(float radius)
{
    constexpr uint32_t kCorners = 64;
    const float turn = 2.0f * kPi / float(kCorners);
    const float corner = radius * std::sqrt(turn / std::sin(turn));
    const float z = 2e-4f;
    std::vector<Vec3> positions;
    std::vector<UVec3> triangles;
    for (uint32_t k = 0; k < kCorners; ++k)
    {
        const float c = std::cos(turn * float(k)), s = std::sin(turn * float(k));
        positions.push_back({corner * c, corner * s, z});
        positions.push_back({90.0f * c, 90.0f * s, z});
        const uint32_t next = (k + 1) % kCorners;
        triangles.push_back({2 * k, 2 * k + 1, 2 * next + 1});
        triangles.push_back({2 * k, 2 * next + 1, 2 * next});
    }
    return newMesh(positions, triangles);
}

View downwards(double cosTheta, int pixels)
{
    const double sine = std::sqrt(1.0 - cosTheta * cosTheta);
    return perspectiveView({sine, 0, cosTheta}, {0, 0, 0}, {0, 1, 0}, 1e-3, pixels, pixels);
}

/// Compares half-spaces with 1 - H(mu) sqrt(1 - a) [Chandrasekhar60].
void checkReflectances(int pixels, int passes, double most)
{
    const struct
    {
        float albedo;
        double cosTheta, reflected;
    } cases[] = {{0.5f, 0.1, 0.241721},  {0.5f, 1.0, 0.115226}, {0.9f, 0.1, 0.629336},
                 {0.9f, 0.5, 0.507939},  {0.9f, 1.0, 0.414947}, {0.99f, 0.1, 0.877512},
                 {0.99f, 0.5, 0.815140}, {0.99f, 1.0, 0.752721}};
    for (const auto& c : cases)
    {
        SceneBuilder builder;
        addHalfSpace(builder, mediumOf(1.0f, c.albedo), 1.0f);
        const Estimate seen = measure(builder.build(), downwards(c.cosTheta, pixels),
                                      optionsOf(IntegratorKind::Path, 64), passes);
        CAPTURE(c.albedo, c.cosTheta, c.reflected, seen.mean(), seen.standardError());
        CHECK(seen.agrees(c.reflected));
        CHECK(seen.standardError() < most);
    }
}

} // namespace

TEST_CASE("media: the reflectance of a half-space", "[integrators][statistics][media][long]")
{
    checkReflectances(16, 4, 5e-3);
}

TEST_CASE("media: a searchlight comes back around where it has entered",
          "[integrators][statistics][media][long]")
{
    // Light that goes the other way: what a ray along the normal finds of a white sky that lights a
    // circle around it is the share of a searchlight that comes back within the circle. Monte
    // Carlo of 1e6 paths, +-0.0005.
    const struct
    {
        float albedo, ior, radius;
        double share;
    } cases[] = {{0.9f, 1.0f, 0.5f, 0.1468},  {0.9f, 1.0f, 2.0f, 0.3230},
                 {0.9f, 1.0f, 10.0f, 0.4141}, {0.99f, 1.0f, 1.0f, 0.2911},
                 {0.99f, 1.0f, 5.0f, 0.6428}, {0.9f, 1.5f, 0.5f, 0.0684},
                 {0.9f, 1.5f, 2.0f, 0.1521},  {0.99f, 1.5f, 5.0f, 0.4139}};
    for (const auto& c : cases)
    {
        SceneBuilder builder;
        addHalfSpace(builder, mediumOf(1.0f, c.albedo), c.ior);
        builder.add(plateWithHole(c.radius), lambert(Vec3(0.0f)));
        const Estimate seen =
            measure(builder.build(), downwards(1.0, 16), optionsOf(IntegratorKind::Path, 64), 4);
        const double mirrored = c.ior == 1.0f ? 0.0 : 0.04;
        CAPTURE(c.albedo, c.ior, c.radius, c.share, seen.mean() - mirrored, seen.standardError());
        CHECK(seen.agrees(c.share + mirrored, 0.001));
        CHECK(seen.standardError() < 4e-3);
    }
}
