// MediaLightTest.cpp - light in homogeneous media compared with closed forms.
// SPDX-License-Identifier: MIT
#include "tests/integrators/MediaScenes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a view of one ray from the origin along +x.
View fromOrigin()
{
    return perspectiveView({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 1e-3, 4, 4);
}

/// Returns a point light of radiant intensity 1 W/sr.
Light unitLight(Vec3 position)
{
    return pointLight(position, Vec3(float(1.0 / 3.14159265358979)));
}

/// Adds a black wall across the ray, which ends what the ray travels through.
void addWall(SceneBuilder& builder, float distance)
{
    builder.add(quadMesh({distance, -500, -500}, {0, 1000, 0}, {0, 0, 1000}), lambert(Vec3(0.0f)));
}

struct AirLight
{
    float sigmaT, sigmaS, along, across, length, g;
    double radiance;
};

// Quadrature of sigmaS integral of p exp(-sigmaT (t + d)) / d^2 dt over the ray, d the distance of
// the light from the point at t [Sun05, Pegoraro09].
const AirLight kAirLights[] = {
    {1.0f, 1.0f, 1.0f, 1.0f, 60.0f, 0.0f, 0.01745864},
    {1.0f, 1.0f, 1.0f, 1.0f, 60.0f, 0.5f, 0.01492677},
    {1.0f, 1.0f, 1.0f, 1.0f, 60.0f, -0.5f, 0.01007126},
    {1.0f, 0.5f, 1.0f, 0.1f, 60.0f, 0.0f, 0.36338790},
    {0.1f, 0.1f, 5.0f, 1.0f, 10.0f, 0.0f, 0.01137522},
    {0.1f, 0.1f, 5.0f, 1.0f, 10.0f, 0.9f, 0.01143503},
    {10.0f, 9.0f, 1.0f, 0.5f, 60.0f, 0.0f, 6.6831234e-6},
    {1e-9f, 1e-9f, 5.0f, 1.0f, 10.0f, 0.0f, 2.1858352e-10},
};

} // namespace

TEST_CASE("media: air light of a point light", "[integrators][statistics][media]")
{
    for (const AirLight& c : kAirLights)
    {
        SceneBuilder builder;
        Medium medium = mediumOf(c.sigmaT, c.sigmaS / c.sigmaT, c.g);
        setAtmosphere(builder, medium, 900.0f);
        addWall(builder, c.length);
        builder.addLight(unitLight({c.along, c.across, 0}));
        const Estimate seen =
            measure(builder.build(), fromOrigin(), optionsOf(IntegratorKind::Path, 1), 8);
        CAPTURE(c.sigmaT, c.g, c.radiance, seen.mean(), seen.standardError());
        CHECK(seen.agrees(c.radiance, 2e-5 * c.radiance));
        CHECK(seen.standardError() < (c.sigmaT > 5.0f || c.g > 0.6f ? 0.1 : 0.02) * c.radiance);
    }
}

TEST_CASE("media: light falls by Beer's law, and emission adds up", "[integrators][media]")
{
    const Vec3 sigma(0.25f, 0.5f, 1.0f), emission(0.3f, 0.2f, 0.1f);
    for (const bool scatters : {false, true})
    {
        SceneBuilder builder;
        Medium medium;
        medium.sigmaA = scatters ? Vec3(0.0f) : sigma;
        medium.sigmaS = scatters ? sigma : Vec3(0.0f);
        medium.emission = emission;
        setAtmosphere(builder, medium, 100.0f);
        Material wall = lamp(Vec3(8.0f));
        builder.add(quadMesh({2, -50, -50}, {0, 0, 100}, {0, 100, 0}), wall);
        // One edge: what is scattered out of the ray does not come back.
        const Vec3 seen =
            render(builder.build(), fromOrigin(), optionsOf(IntegratorKind::Path, 1), 1).mean();
        for (int c = 0; c < 3; ++c)
        {
            const double left = std::exp(-2.0 * double(sigma[c]));
            const double expected =
                8.0 * left + double(emission[c]) * (1.0 - left) / double(sigma[c]);
            CAPTURE(scatters, c);
            CHECK(seen[c] == Approx(expected).epsilon(1e-4));
        }
    }
}

TEST_CASE("media: a sun through a slot", "[integrators][statistics][media]")
{
    // E = 1, depth 2 of the ray below the entry of the light, lit length 3, sigma = 0.1:
    // L = E p e^(-sigma y) (1 - e^(-sigma L)).
    SceneBuilder builder;
    setAtmosphere(builder, mediumOf(0.1f, 1.0f), 900.0f, {0, 0, 2 - 900.0f});
    addWall(builder, 3.0f);
    Light sun;
    sun.kind = LightKind::Directional;
    sun.direction = Vec3(0, 0, -1);
    sun.diffuse = Vec3(float(1.0 / 3.14159265358979));
    builder.addLight(sun);
    const Estimate seen =
        measure(builder.build(), fromOrigin(), optionsOf(IntegratorKind::Path, 1), 8);
    CAPTURE(seen.mean(), seen.standardError());
    CHECK(seen.agrees(0.016886347, 2e-5));
    CHECK(seen.standardError() < 2e-5);
}
