// FurnaceTest.cpp - closed rooms whose radiance is known.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Material furnaceWall(float albedo)
{
    Material wall = lambert(Vec3(albedo));
    wall.emission = Vec3(1.0f);
    return wall;
}

View insideView(int pixels)
{
    return perspectiveView({0.1, 0.2, -0.1}, {0.3, 0.1, 0.8}, {0, 1, 0}, 80.0, pixels, pixels);
}

/// Returns the radiance of a room of emission 1 after this many bounces.
double truncated(double albedo, int bounces)
{
    return (1.0 - std::pow(albedo, bounces + 1)) / (1.0 - albedo);
}

} // namespace

TEST_CASE("furnace: path tracing reaches Le / (1 - rho), cut after maxBounces",
          "[integrators][statistics][long]")
{
    const struct
    {
        float albedo;
        int bounces;
        double radiance;
    } cases[] = {{0.5f, 64, 2.0}, {0.9f, 8, 6.125795}, {0.9f, 64, 9.989389},
                 {0.9f, 0, 1.0},  {0.9f, 1, 1.9},      {0.99f, 64, 47.966}};
    for (const auto& c : cases)
    {
        CHECK(truncated(c.albedo, c.bounces) == Approx(c.radiance).epsilon(2e-5));
        SceneBuilder box, sphere;
        box.addEmissive(boxMesh(Vec3(-1.0f), Vec3(1.0f)), furnaceWall(c.albedo));
        sphere.addEmissive(sphereMesh(Vec3(0.0f), 1.0f, 24), furnaceWall(c.albedo));
        for (const SceneBuilder* room : {&box, &sphere})
        {
            CAPTURE(c.albedo, c.bounces, room == &box);
            const Estimate radiance = measure(room->build(), insideView(32),
                                              optionsOf(IntegratorKind::Path, c.bounces), 2);
            CAPTURE(radiance.mean(), radiance.standardError());
            CHECK(radiance.agrees(c.radiance, 2e-5 * c.radiance));
            CHECK(radiance.standardError() < 0.0025 * c.radiance); // shows densities off by 2 %
        }
    }
}

TEST_CASE("furnace: the same far from the origin", "[integrators][statistics][long]")
{
    // Leaks would show as a loss of light. At this distance ray offsets are 0.6, and the error of
    // positions is about 1e-3 of the radius.
    const Vec3 centre(148376.0f, 1234.0f, -223423.0f);
    SceneBuilder sphere;
    sphere.addEmissive(sphereMesh(centre, 200.0f, 24), furnaceWall(0.5f));
    const View view =
        perspectiveView(Vec3d(centre), Vec3d(centre) + Vec3d(1, 0.2, 0.3), {0, 0, 1}, 80.0, 32, 32);
    const Estimate radiance = measure(sphere.build(), view, optionsOf(IntegratorKind::Path, 64), 8);
    CAPTURE(radiance.mean(), radiance.standardError());
    CHECK(radiance.agrees(2.0, 2e-3));
}

TEST_CASE("furnace: Whitted's one bounce gives Le (1 + rho)", "[integrators][statistics]")
{
    SceneBuilder sphere;
    sphere.addEmissive(sphereMesh(Vec3(0.0f), 1.0f, 48), furnaceWall(0.6f));
    const Estimate radiance =
        measure(sphere.build(), insideView(32), optionsOf(IntegratorKind::Whitted), 8);
    CAPTURE(radiance.mean(), radiance.standardError());
    CHECK(radiance.agrees(1.6, 2e-5));
}

TEST_CASE("sphere: a point light of intensity pi in a sphere of albedo 1/2 gives radiance 1",
          "[integrators][statistics][long]")
{
    // A light of diffuse 1 and quadratic attenuation has the intensity pi [W/sr].
    SceneBuilder sphere;
    sphere.add(sphereMesh(Vec3(0.0f), 1.0f, 100), lambert(Vec3(0.5f)));
    sphere.addLight(pointLight(Vec3(0.0f)));
    const auto traced = sphere.build();
    const Estimate path = measure(traced, insideView(32), optionsOf(IntegratorKind::Path, 64), 16);
    CAPTURE(path.mean(), path.standardError());
    CHECK(path.agrees(1.0, 1e-3)); // 100 rows of facets are 5e-4 inside the sphere
    const Estimate direct = measure(traced, insideView(32), optionsOf(IntegratorKind::Whitted), 1);
    CHECK(direct.mean() == Approx(0.5).margin(5e-4));
}

TEST_CASE("integrating sphere: indirect light is uniform wherever the light is",
          "[integrators][statistics][long]")
{
    // The direct radiance is rho cos / d^2. The indirect radiance is rho E_ind / pi with E_ind =
    // rho Phi / (4 pi (1 - rho)) and Phi = 4 pi^2.
    SceneBuilder sphere;
    sphere.add(sphereMesh(Vec3(0.0f), 1.0f, 100), lambert(Vec3(0.5f)));
    sphere.addLight(pointLight(Vec3(0.0f, 0.0f, 0.5f)));
    const auto traced = sphere.build();
    const RenderOptions options = optionsOf(IntegratorKind::Path, 64);
    for (const float pole : {1.0f, -1.0f})
    {
        // The patch is halfway up the pyramid of facets around the pole.
        const double distance = std::abs(double(pole) - 0.5);
        const View patch = patchView({0.0, 0.0, 0.9995 * pole}, {0, 0, -pole}, 0.05, 16);
        const Estimate radiance = measure(traced, patch, options, 64);
        const double expected = 0.5 / (distance * distance) + 0.5;
        CAPTURE(pole, radiance.mean(), radiance.standardError());
        CHECK(radiance.agrees(expected, 5e-3 * expected));
    }
}
