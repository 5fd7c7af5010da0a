// MediaBodiesTest.cpp - balls, slabs and other bodies filled with media, in skies and under suns.
// SPDX-License-Identifier: MIT
#include "tests/integrators/MediaScenes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns the mean radiance of a ball of radius 1 over its disc, seen from far away.
Estimate discOf(const SceneBuilder& builder, int bounces, int passes)
{
    const double side = 2.2;
    View view = patchView({0, 0, 4}, {0, 0, 1}, side, 32);
    Estimate estimate;
    RenderOptions options = optionsOf(IntegratorKind::Path, bounces);
    const auto traced = builder.build();
    for (uint32_t seed = 0; seed < 16; ++seed)
    {
        options.seed = seed;
        const Picture picture = render(traced, view, options, passes);
        REQUIRE(picture.progress.droppedSamples == 0);
        // Around the disc the sky is seen, of radiance 1.
        const double disc = 3.14159265358979 / (side * side);
        estimate.add((double(picture.mean().y) - (1.0 - disc)) / disc);
    }
    return estimate;
}

SceneBuilder ball(const Medium& medium, float ior)
{
    SceneBuilder builder;
    builder.add(sphereMesh(Vec3(0.0f), 1.0f, 96), bodyOf(medium, ior));
    addSky(builder);
    return builder;
}

} // namespace

TEST_CASE("media: a ball in a white sky", "[integrators][statistics][media]")
{
    // Monte Carlo of 4e5 paths, +-0.0005; the facets of the ball are 5e-4 smaller than a sphere.
    const struct
    {
        float depth, albedo, ior;
        double share;
    } cases[] = {{1, 0.5f, 1, 0.5426},    {1, 0.9f, 1, 0.8779},     {1, 0.99f, 1, 0.9868},
                 {10, 0.5f, 1, 0.1708},   {10, 0.9f, 1, 0.5459},    {1, 0.5f, 1.5f, 0.4055},
                 {1, 0.9f, 1.5f, 0.7726}, {10, 0.5f, 1.5f, 0.1428}, {10, 0.9f, 1.5f, 0.3586}};
    for (const auto& c : cases)
    {
        const Estimate seen = discOf(ball(mediumOf(c.depth, c.albedo), c.ior), 64, 1);
        CAPTURE(c.depth, c.albedo, c.ior, c.share, seen.mean(), seen.standardError());
        CHECK(seen.agrees(c.share, 0.0015));
    }
}

TEST_CASE("media: a ball that only absorbs", "[integrators][statistics][media]")
{
    for (const double depth : {0.01, 0.1, 1.0, 10.0})
    {
        const double expected =
            (1.0 - (1.0 + 2.0 * depth) * std::exp(-2.0 * depth)) / (2.0 * depth * depth);
        const Estimate seen = discOf(ball(mediumOf(float(depth), 0.0f), 1.0f), 8, 2);
        CAPTURE(depth, expected, seen.mean(), seen.standardError());
        CHECK(seen.agrees(expected, 0.0015));
    }
}

TEST_CASE("media: what scatters without absorbing is not seen in a white sky",
          "[integrators][statistics][media]")
{
    for (const float ior : {1.0f, 1.5f})
        for (const float g : {0.0f, 0.8f, -0.5f})
        {
            SceneBuilder builder = ball(mediumOf(3.0f, 1.0f, g), ior);
            Medium air = mediumOf(0.1f, 1.0f, 0.3f);
            setAtmosphere(builder, air, 3.0f);
            const Estimate seen = discOf(builder, 64, 1);
            CAPTURE(ior, g, seen.mean(), seen.standardError());
            CHECK(seen.agrees(1.0, 1e-3));
        }
}
