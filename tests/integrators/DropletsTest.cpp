// DropletsTest.cpp - light in media of water droplets, by all that traces it without photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/PhaseFunction.h"

#include "tests/integrators/VolumeScenes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Medium dropletsOf(float sigmaT, float albedo, float micrometres)
{
    Medium medium = mediumOf(sigmaT, albedo);
    medium.dropletSize = micrometres;
    return medium;
}

enum class Place
{
    Air,
    Body,
    Grid
};

/// Adds a medium to the air, or to a box around the ray from the origin along +x.
void addMedium(SceneBuilder& builder, Place place, const Medium& medium)
{
    const Vec3 low(1, -2, -2), high(3, 2, 2);
    if (place == Place::Air)
        setAtmosphere(builder, medium, 9.0f);
    else if (place == Place::Body)
        builder.add(boxMesh(low, high), bodyOf(medium));
    else
    {
        const auto one = [](int, int, int) { return 1.0f; };
        Volume volume = densityIn(low, high, newVolumeImage(2, 2, 2, one), medium);
        makeEven(volume, Vec4(1.0f));
        builder.scene->volumes.push_back(volume);
    }
}

} // namespace

TEST_CASE("droplets: what is scattered once has the phase function's share of the light",
          "[integrators][media][volumes]")
{
    const View view = perspectiveView({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 1e-3, 4, 4);
    for (const Place place : {Place::Air, Place::Body, Place::Grid})
        for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
            for (const float degrees : {8.0f, 60.0f, 142.0f, 178.0f})
            {
                if (place == Place::Grid && kind == IntegratorKind::Whitted) continue;
                const float turn = glm::radians(degrees);
                std::array<double, 2> seen;
                for (const bool droplets : {false, true})
                {
                    SceneBuilder builder;
                    addMedium(builder, place,
                              droplets ? dropletsOf(0.2f, 0.7f, 12.0f) : mediumOf(0.2f, 0.7f));
                    Light sun;
                    sun.kind = LightKind::Directional;
                    sun.direction = Vec3(-std::cos(turn), 0.0f, -std::sin(turn));
                    sun.diffuse = Vec3(1.0f);
                    builder.addLight(sun);
                    // One edge, and the same samples: the phase function is all that differs.
                    seen[droplets] =
                        double(render(builder.build(), view, optionsOf(kind, 1), 4).mean().y);
                }
                const double expected =
                    double(evalPhase(dropletPhase(12.0f), std::cos(turn))) * 4.0 * 3.14159265358979;
                CAPTURE(int(place), int(kind), degrees, seen[0], seen[1]);
                REQUIRE(seen[0] > 0.0);
                CHECK(seen[1] / seen[0] == Approx(expected).epsilon(2e-3));
            }
}

TEST_CASE("droplets: no light is lost or gained in a white sky",
          "[integrators][statistics][media][volumes]")
{
    const View view = perspectiveView({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 20.0, 4, 4);
    for (const Place place : {Place::Air, Place::Body, Place::Grid})
    {
        SceneBuilder builder;
        addMedium(builder, place, dropletsOf(1.5f, 1.0f, 20.0f));
        addSky(builder);
        const Estimate seen =
            measure(builder.build(), view, optionsOf(IntegratorKind::Path, 4), 16);
        CAPTURE(int(place), seen.mean(), seen.standardError());
        CHECK(seen.agrees(1.0, 1e-4));
        CHECK(seen.standardError() < 0.01);
    }
}
