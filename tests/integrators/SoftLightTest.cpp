// SoftLightTest.cpp - lights with a size, by every estimator: irradiance, shadows, and the limit of
// no size.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Vec3 towards(double degrees)
{
    const double angle = glm::radians(degrees);
    return Vec3(std::sin(angle), 0.0, std::cos(angle));
}

/// Returns a light of radiance 1 whose centre is 2 radii away from the origin.
Light sphereLight(double degrees)
{
    Light light = pointLight(2.0f * towards(degrees));
    light.radius = 1.0f;
    return light;
}

/// Returns a light of radiance 1 in a half-angle of 30 degrees.
Light sun(double degrees)
{
    Light light;
    light.kind = LightKind::Directional;
    light.direction = -towards(degrees);
    light.sine = 0.5f;
    light.diffuse = Vec3(0.25f);
    return light;
}

SceneBuilder receiver(const Light& light)
{
    SceneBuilder builder;
    builder.add(quadMesh({-0.05f, -0.05f, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}), lambert(Vec3(1.0f)));
    builder.addLight(light);
    return builder;
}

View receiverView()
{
    return patchView({0, 0, 0}, {0, 0, 1}, 1e-4, 16);
}

struct Known
{
    double degrees, irradiance; ///< [Snyder96], by the angle of the centre
};

constexpr Known kKnown[] = {{0.0, 0.78539816},
                            {60.0, 0.39269908},
                            {75.0, 0.22120088},
                            {90.0, 0.09058607},
                            {100.0, 0.03544902}};

/// Checks that the irradiance is right within 4 sigma and within 0.1 %, and that the standard error
/// is at most a quarter of this.
void check(const Estimate& radiance, double irradiance)
{
    CAPTURE(radiance.mean() * M_PI, radiance.standardError() * M_PI, irradiance);
    CHECK(radiance.agrees(irradiance / M_PI, 1e-6));
    CHECK(std::abs(radiance.mean() * M_PI - irradiance) < 1e-3 * irradiance);
    CHECK(radiance.standardError() * M_PI < 2.5e-4 * irradiance);
}

/// Returns a floor with a ball above it.
SceneBuilder ballOverFloor()
{
    SceneBuilder builder;
    builder.add(quadMesh({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}), lambert(Vec3(0.7f)));
    builder.add(sphereMesh({0, 0, 1}, 0.5f, 24), lambert(Vec3(0.5f)));
    return builder;
}

} // namespace

TEST_CASE("soft light: irradiance by path tracing", "[integrators][statistics][stability 24][long]")
{
    for (const Known& known : kKnown)
    {
        CAPTURE(known.degrees);
        const int passes = known.degrees > 90.0 ? 384 : 128; // few samples are above the horizon
        for (const Light& light : {sphereLight(known.degrees), sun(known.degrees)})
            check(measure(receiver(light).build(), receiverView(),
                          optionsOf(IntegratorKind::Path, 1), passes),
                  known.irradiance);
    }
}

TEST_CASE("soft light: irradiance by Whitted's light samples, with every strategy",
          "[integrators][statistics][stability 24][long]")
{
    const auto traced = receiver(sphereLight(90.0)).build(); // half of it is below the horizon
    for (const LightSampling strategy : {LightSampling::Random, LightSampling::UniformJitter,
                                         LightSampling::Stratified, LightSampling::Sobol})
    {
        RenderOptions options = optionsOf(IntegratorKind::Whitted);
        options.lightSampling = strategy;
        options.lightSamples = 100;
        CAPTURE(int(strategy));
        check(measure(traced, receiverView(), options, 64), 0.09058607);
    }
}

// A unit square hides 0.75227469 [Lambert60] of the sphere's pi sin^2 a.
TEST_CASE("soft light: what stands between shadows its part", "[integrators][statistics]")
{
    Light light = pointLight({0, 0, 4});
    light.radius = 2.8f;
    light.diffuse = Vec3(2.8f * 2.8f);
    SceneBuilder builder = receiver(light);
    builder.add(quadMesh({-0.5f, -0.5f, 1}, {0, 1, 0}, {1, 0, 0}), lambert(Vec3(0.0f)));
    const double expected = M_PI * 0.49 - 0.75227469;
    check(measure(builder.build(), receiverView(), optionsOf(IntegratorKind::Path, 1), 512),
          expected);
    RenderOptions options = optionsOf(IntegratorKind::Whitted);
    options.lightSamples = 64;
    check(measure(builder.build(), receiverView(), options, 16), expected);
}

// In the limit of no size the picture is that of the point light, with the edge of its hard shadow.
TEST_CASE("soft light: a tiny one is the point light", "[integrators]")
{
    for (const bool directional : {false, true})
    {
        SceneBuilder hard = ballOverFloor(), soft = ballOverFloor();
        Light light = directional ? sun(20.0) : pointLight({0.4f, -0.3f, 3});
        light.sine = 0.0f;
        hard.addLight(light);
        light.radius = 3e-6f;
        light.sine = 1e-6f;
        soft.addLight(light);
        const View view = perspectiveView({2, -4, 3}, {0, 0, 0.5}, {0, 0, 1}, 40, 64, 64);
        for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
        {
            const RenderOptions options = optionsOf(kind, 1);
            const Picture a = render(hard.build(), view, options, 4);
            const Picture b = render(soft.build(), view, options, 4);
            double worst = 0.0, lit = 0.0;
            for (std::size_t k = 0; k < a.rgba.size(); ++k)
            {
                worst = std::max(worst, double(std::fabs(a.rgba[k] - b.rgba[k])));
                lit += a.rgba[k];
            }
            CAPTURE(directional, int(kind), worst);
            CHECK(lit > 100.0);
            CHECK(worst < 2e-5);
        }
    }
}

// OpenGL's materials get the same light, and soft shadows as well.
TEST_CASE("soft light: fixed-function surfaces", "[integrators][statistics][long]")
{
    Material material;
    material.ambient = Vec3(0.0f);
    material.diffuse = Vec3(1.0f);
    for (const Known& known : kKnown)
    {
        SceneBuilder builder;
        builder.add(quadMesh({-0.05f, -0.05f, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}), material);
        Light light = sphereLight(known.degrees);
        light.ambient = Vec3(0.0f);
        builder.addLight(light);
        RenderOptions options = optionsOf(IntegratorKind::Whitted);
        options.lightSamples = 64;
        CAPTURE(known.degrees);
        check(measure(builder.build(), receiverView(), options, 16), known.irradiance);
    }
    // The ambient term is that of the point light.
    material.ambient = Vec3(1.0f);
    material.diffuse = Vec3(0.0f);
    SceneBuilder builder;
    builder.add(quadMesh({-0.05f, -0.05f, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}), material);
    Light light = sphereLight(30.0);
    light.ambient = Vec3(0.5f);
    builder.addLight(light);
    builder.scene->ambient = Vec3(0.0f);
    const Vec3 mean =
        render(builder.build(), receiverView(), optionsOf(IntegratorKind::Whitted), 2).mean();
    CHECK(mean.y == Approx(0.5 / 4.0).epsilon(1e-5));
}

TEST_CASE("soft light: not seen by cameras and mirrors", "[integrators]")
{
    SceneBuilder builder;
    builder.add(quadMesh({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}), mirror(Vec3(1.0f)));
    Light light = pointLight({0, 0, 1});
    light.radius = 0.5f;
    builder.addLight(light);
    const View view = perspectiveView({0, -3, 2}, {0, 0, 0.5}, {0, 0, 1}, 50, 32, 32);
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
        CHECK(render(builder.build(), view, optionsOf(kind), 8).mean() == Vec3(0.0f));
}
