// SoftLightTest.cpp - spheres and suns: cones, weights and the irradiance that they cause.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

#include "osgRayTrace/shading/SoftLight.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr double kPiD = glm::pi<double>();

/// Returns a sphere whose radiance is 1 if it fades with the square of the distance.
Light sphereLight(Vec3 position, float radius)
{
    Light light = pointLight(position, Vec3(radius * radius));
    light.radius = radius;
    return light;
}

Light sun(Vec3 direction, float sine)
{
    Light light;
    light.kind = LightKind::Directional;
    light.direction = glm::normalize(direction);
    light.diffuse = Vec3(sine * sine); // gives a radiance of 1
    light.sine = sine;
    return light;
}

/// Returns the irradiance at the origin, with the normal +z, by side x side points of the square.
double irradiance(const Light& light, int side)
{
    double sum = 0.0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
        {
            const Vec2 u((static_cast<float>(x) + 0.5f) / static_cast<float>(side),
                         (static_cast<float>(y) + 0.5f) / static_cast<float>(side));
            const SoftLightSample sample = sampleSoft(light, Vec3(0.0f), u);
            sum += std::max(0.0, double(sample.wi.z)) * sample.weight * sample.attenuation;
        }
    return kPiD * light.diffuse.x * sum / side / side;
}

Vec3 towards(double degrees)
{
    const double angle = glm::radians(degrees);
    return Vec3(std::sin(angle), 0.0, std::cos(angle));
}

/// Divides the azimuth around an axis into sectors.
struct Sectors
{
    explicit Sectors(Vec3 axis)
    {
        const Vec3d n(axis);
        x = glm::normalize(glm::cross(n, Vec3d(0, 0, 1)));
        y = glm::cross(n, x);
    }
    int of(Vec3d w, int count) const
    {
        const double turn = std::atan2(glm::dot(w, y), glm::dot(w, x)) / (2.0 * kPiD) + 0.5;
        return std::clamp(int(turn * count), 0, count - 1);
    }
    Vec3d x, y;
};

struct Known
{
    double degrees, irradiance; ///< of radiance 1 under a half-angle of 30 degrees [Snyder96]
};

constexpr Known kKnown[] = {{0.0, 0.78539816},  {60.0, 0.39269908},  {75.0, 0.22120088},
                            {90.0, 0.09058607}, {100.0, 0.03544902}, {121.0, 0.0}};

} // namespace

TEST_CASE("soft light: irradiance above, at and below the horizon", "[shading][stability 24]")
{
    for (const Known& known : kKnown)
    {
        CAPTURE(known.degrees);
        const Vec3 axis = towards(known.degrees);
        CHECK(irradiance(sphereLight(2.0f * axis, 1.0f), 1024) ==
              Approx(known.irradiance).epsilon(1e-4).margin(1e-9));
        CHECK(irradiance(sun(-axis, 0.5f), 1024) ==
              Approx(known.irradiance).epsilon(1e-4).margin(1e-9));
    }
}

TEST_CASE("soft light: 1 - cosine has no cancellation", "[shading]")
{
    for (double sine = 1.0; sine > 1e-15; sine *= 0.7)
    {
        const double sine2 = double(float(sine)) * double(float(sine));
        const double exact = sine2 / (1.0 + std::sqrt(1.0 - sine2));
        CAPTURE(sine);
        CHECK(std::abs(oneMinusCosine(float(sine)) - exact) <= 3e-7 * exact);
        CHECK(softWeight(float(sine)) == Approx(2.0 / (2.0 - exact)).epsilon(2e-7));
    }
}

// The irradiance is that of the point light for all sizes, as long as no part of the light is below
// the horizon.
TEST_CASE("soft light: tiny and far ones are the point light", "[shading]")
{
    for (const float radius : {1.0f, 0.1f, 1e-3f, 1e-6f, 1e-20f})
    {
        for (const float scale : {1e-9f, 1.0f, 1e12f})
        {
            Light light = pointLight(2.0f * scale * towards(30.0), Vec3(1.0f));
            light.attenuationQuadratic = 1.0f / scale / scale;
            const double point = sampleDelta(light, Vec3(0.0f)).attenuation;
            light.radius = radius * scale;
            CAPTURE(radius, scale);
            CHECK(irradiance(light, 256) ==
                  Approx(kPiD * point * std::cos(glm::radians(30.0))).epsilon(2e-5));
        }
    }
}

// Inside the light the irradiance is that on its surface: neither 0 nor infinite.
TEST_CASE("soft light: from outside to inside there is no step", "[shading]")
{
    const auto at = [](float distance) {
        return irradiance(sphereLight({0, 0, distance}, 1.0f), 512);
    };
    CHECK(at(1.0001f) == Approx(kPiD).epsilon(1e-3));
    CHECK(at(0.9999f) == Approx(kPiD).epsilon(1e-3));
    CHECK(at(0.01f) == Approx(kPiD).epsilon(1e-3));
    CHECK(sampleSoft(sphereLight({0, 0, 0}, 1.0f), Vec3(0.0f), Vec2(0.5f)).attenuation == 0.0f);
}

// Each test has a false alarm of 1e-3.
TEST_CASE("soft light: directions are uniform in the cone, and end at the disc",
          "[shading][statistics]")
{
    Uniform uniform(11);
    for (const float sine : {1.0f, 0.7f, 0.05f})
    {
        constexpr int kCells = 12, kSamples = 100000;
        const Vec3 axis = glm::normalize(Vec3(0.3f, -0.8f, 0.4f));
        const Light light = sphereLight(3.0f / sine * axis, 3.0f);
        const Sectors sectors(axis);
        std::vector<double> counts(kCells * kCells),
            expected(kCells * kCells, double(kSamples) / kCells / kCells);
        for (int k = 0; k < kSamples; ++k)
        {
            const SoftLightSample sample =
                sampleSoft(light, Vec3(0.0f), Vec2(uniform(), uniform()));
            const Vec3d wi(sample.wi);
            const double height = (1.0 - glm::dot(wi, Vec3d(axis)) / glm::length(wi)) /
                                  (1.0 - std::sqrt(1.0 - double(sine) * sine));
            const int row = std::clamp(int(height * kCells), 0, kCells - 1);
            counts[std::size_t(row * kCells + sectors.of(wi, kCells))] += 1.0;
            // The disc has its centre at the light's and faces the ray.
            const Vec3d end = wi * double(sample.distance) - Vec3d(light.position);
            REQUIRE(std::abs(glm::dot(end, wi)) < 1e-4 * glm::length(light.position));
            REQUIRE(glm::length(end) < 3.001);
        }
        CAPTURE(sine);
        CHECK(chiSquareTest(counts, expected) > 1e-3);
    }
}

TEST_CASE("soft light: a spot's profile belongs to directions", "[shading]")
{
    Light light = sphereLight({0, 0, 2}, 1.0f);
    light.direction = {0, 0, -1};
    light.spotCosCutoff = std::cos(glm::radians(20.0f));
    light.spotExponent = 3.0f;
    // The mean over the cone of 30 degrees of cos^4 within 20 degrees, times the cone's solid
    // angle, is 2 pi (1 - c^5) / 5.
    const double c = light.spotCosCutoff;
    CHECK(irradiance(light, 1024) ==
          Approx(2.0 * kPiD * (1.0 - std::pow(c, 5)) / 5.0).epsilon(1e-3));
}
