// PhotonLeakTest.cpp - which light leaks past walls and edges, how much, and how it vanishes.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/photons/PhotonMap.h"
#include "osgRayTrace/photons/RadiusSchedule.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr float kThickness = 1e-3f;

/// Adds one photon at a random place of each cell of a side x side grid over corner, u, v.
void addPhotons(std::vector<Photon>& photons, Vec3 corner, Vec3 u, Vec3 v, Vec3 normal, int side)
{
    Uniform uniform(3);
    for (int k = 0; k < side * side; ++k)
    {
        Photon p;
        const auto x = static_cast<float>(k % side), y = static_cast<float>(k / side);
        p.position = corner + u * ((x + uniform()) / static_cast<float>(side)) +
                     v * ((y + uniform()) / static_cast<float>(side));
        p.normal = normal;
        p.wi = glm::normalize(Vec3(1, 0, 1)); // reaches both faces of the corner
        p.power = Vec3(1.0f / static_cast<float>(side * side));
        photons.push_back(p);
    }
}

PhotonQuery query(Vec3 position, Vec3 normal, float radius)
{
    PhotonQuery q;
    q.position = position;
    q.normal = q.shadingNormal = normal;
    q.radius = radius;
    return q;
}

/// Counts the photons within the radius, whatever surface they belong to.
uint32_t near(const std::vector<Photon>& photons, Vec3 position, float radius)
{
    uint32_t count = 0;
    for (const Photon& p : photons)
        count += glm::length(p.position - position) <= radius;
    return count;
}

/// Returns the part of discs of radius 1 that is on the lit side, if their centres lie on the dark
/// side of a wall of this thickness, at its foot and beyond, summed over the distance of the
/// centres. Without a wall it is 2/(3 pi).
double litPart(double thickness)
{
    constexpr int kSteps = 20000;
    double sum = 0.0;
    for (int k = 0; k < kSteps; ++k)
    {
        const double u = (k + 0.5) / kSteps;
        if (u > thickness) sum += std::acos(u) - u * std::sqrt(1.0 - u * u);
    }
    return sum / kSteps / M_PI;
}

} // namespace

TEST_CASE("stability 44: nothing leaks through a thin wall, round a corner or over a step",
          "[photons][stability 44]")
{
    const Workers workers(2);
    constexpr float kRadius = 1e-2f;
    const Vec3 up(0, 0, 1), left(-1, 0, 0), right(1, 0, 0);
    // The photons lie on the lit face of a wall and on the lit floor before it.
    std::vector<Photon> photons;
    addPhotons(photons, {kThickness, -0.1f, 0}, {0, 0.2f, 0}, {0, 0, 0.2f}, right, 300);
    addPhotons(photons, {kThickness, -0.1f, 0}, {0, 0.2f, 0}, {0.2f, 0, 0}, up, 300);
    const PhotonMap map(photons, 2.0f * kRadius, workers);
    Uniform uniform(4);
    uint64_t close = 0;
    for (int k = 0; k < 50; ++k)
    {
        // The point is on the dark face, down to the foot: all photons near by are behind the face,
        // or on surfaces turned away.
        const Vec3 dark(0.0f, 0.1f * uniform() - 0.05f, 0.02f * uniform());
        close += near(photons, dark, kRadius);
        CHECK(map.gather(query(dark, left, kRadius)).count == 0);
        // In the corner each face has its own photons and none of the other face.
        const Vec3 foot(kThickness, dark.y, 0.0f);
        const uint32_t floor = map.gather(query(foot, up, kRadius)).count;
        const uint32_t wall = map.gather(query(foot, right, kRadius)).count;
        const double half = 0.5 * M_PI * kRadius * kRadius / 0.04 * 90000.0; // of a disc
        CHECK(floor == Approx(half).epsilon(0.1));
        CHECK(wall == Approx(half).epsilon(0.1));
    }
    CHECK(close > 50 * 100); // without the limits all of them would have been found

    // A lower floor of the same direction contributes while it is within kGapShare of the radius,
    // and not beyond.
    constexpr float kStep = 0.004f;
    const Vec3 above(kThickness + 0.1f, 0.0f, kStep);
    CHECK(map.gather(query(above, up, 33.0f * kStep)).count > 1000);
    CHECK(map.gather(query(above, up, 31.0f * kStep)).count == 0);
    CHECK(near(photons, above, 31.0f * kStep) > 1000);
    // A floor that slopes by less than 60 degrees finds the photons; a steeper one finds none.
    const auto slope = [](double degrees)
    { return Vec3(std::sin(glm::radians(degrees)), 0.0, std::cos(glm::radians(degrees))); };
    const Vec3 ground(kThickness + 0.1f, 0.0f, 0.0f);
    CHECK(map.gather(query(ground, slope(59.0), kRadius)).count > 100);
    CHECK(map.gather(query(ground, slope(61.0), kRadius)).count == 0);
}

// One floor on both sides of a wall cannot be told apart by planes and normals: a strip as wide as
// the radius, less the wall, gets light. The strip's flux falls with the radius, as the strip does,
// and is gone if the wall is thicker than the radius.
TEST_CASE("stability 44: under a wall a strip leaks, in proportion to the radius",
          "[photons][stability 44]")
{
    const Workers workers(2);
    std::vector<Photon> photons;
    addPhotons(photons, {0, -0.1f, 0}, {0, 0.2f, 0}, {0.2f, 0, 0}, Vec3(0, 0, 1), 1000);
    const PhotonMap map(photons, 0.02f, workers);
    // Returns the radiant flux per length of a wall of the given thickness; the irradiance is 1 /
    // 0.04.
    const auto leaked = [&](double thickness, double radius)
    {
        constexpr int kSide = 48;
        double sum = 0.0;
        for (int k = 0; k < kSide * kSide; ++k)
        {
            const double x = (k % kSide + 0.5) / kSide * radius;
            const double y = ((k / kSide + 0.5) / kSide - 0.5) * 0.1;
            const Vec3 at(-thickness - x, y, 0.0);
            sum += double(map.gather(query(at, Vec3(0, 0, 1), float(radius))).power.x);
        }
        return 0.04 * sum / (kSide * kSide) * radius / (M_PI * radius * radius);
    };
    std::vector<double> radii, fluxes;
    for (const double radius : {0.04, 0.02, 0.01, 0.005})
    {
        const double thickness = double(kThickness);
        CAPTURE(radius);
        CHECK(leaked(thickness, radius) ==
              Approx(radius * litPart(thickness / radius)).epsilon(0.02));
        radii.push_back(radius);
        fluxes.push_back(leaked(0.0, radius));
    }
    CHECK(logLogSlope(radii, fluxes) == Approx(1.0).margin(0.02));
    CHECK(litPart(0.0) == Approx(2.0 / (3.0 * M_PI)).epsilon(1e-4));
    CHECK(leaked(double(kThickness), 0.99 * double(kThickness)) == 0.0);
}

// There are 2 comparisons at 4 standard errors of 10 values each: a false alarm of all has a
// probability of 0.006.
TEST_CASE("stability 44: the leak of a picture falls with its passes as the radius does",
          "[photons][statistics][long][stability 44]")
{
    // The scene is a closed, lit room behind a wall, and a dark floor before it.
    SceneBuilder builder;
    const Material white = lambert(Vec3(0.8f));
    builder.add(quadMesh({-1, -1, 0}, {2.5f, 0, 0}, {0, 2, 0}), white);
    builder.add(boxMesh({0, -0.31f, -0.01f}, {kThickness, 0.31f, 0.61f}), white);
    builder.add(boxMesh({0.6f, -0.31f, -0.01f}, {0.61f, 0.31f, 0.61f}), white);
    builder.add(boxMesh({0.0f, -0.31f, -0.01f}, {0.61f, -0.3f, 0.61f}), white);
    builder.add(boxMesh({0.0f, 0.3f, -0.01f}, {0.61f, 0.31f, 0.61f}), white);
    builder.add(boxMesh({0.0f, -0.31f, 0.6f}, {0.61f, 0.31f, 0.61f}), white);
    builder.addQuadLight({0.2f, -0.1f, 0.59f}, {0, 0.2f, 0}, {0.2f, 0, 0}, Vec3(10.0f));
    const auto traced = builder.build();
    constexpr double kWidth = 0.04; // of the visible strip, and the first radius
    const View view = patchView({-0.5 * kWidth, 0, 0}, {0, 0, 1}, kWidth, 16);

    RenderOptions options = optionsOf(IntegratorKind::Path, 6);
    CHECK(render(traced, view, options, 4).mean() == Vec3(0.0f));
    options.integrator = IntegratorKind::Sppm;
    options.photons = 20000;
    options.photonRadius = static_cast<float>(kWidth);
    const auto leakOf = [&](int passes)
    {
        Estimate estimate;
        for (uint32_t seed = 0; seed < 10; ++seed)
        {
            options.seed = 50 * seed + static_cast<uint32_t>(passes);
            estimate.add(double(render(traced, view, options, passes).mean().y));
        }
        return estimate;
    };
    const auto formula = [&](int passes)
    {
        double sum = 0.0;
        for (int pass = 0; pass < passes; ++pass)
        {
            const double alpha = double(options.photonAlpha);
            const double radius = kWidth * std::sqrt(globalRadiusSquared(pass, alpha));
            sum += radius * litPart(double(kThickness) / radius);
        }
        return sum / passes;
    };
    const Estimate few = leakOf(4);
    for (const int passes : {16, 64})
    {
        const Estimate many = leakOf(passes);
        const double ratio = many.mean() / few.mean();
        const double spread = ratio * std::hypot(few.standardError() / few.mean(),
                                                 many.standardError() / many.mean());
        CAPTURE(passes, ratio, formula(passes) / formula(4), spread);
        CHECK(spread < 0.03 * ratio);
        // The lit floor is even to a hundredth.
        CHECK(std::abs(ratio - formula(passes) / formula(4)) <= 4.0 * spread + 0.01);
        CHECK(formula(passes) / formula(4) < (passes == 16 ? 0.85 : 0.70));
    }
}
