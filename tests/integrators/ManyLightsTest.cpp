// ManyLightsTest.cpp - scenes with more lights than a pass samples: the work of a pass is bounded,
// and the mean is right.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"

#include "osgRayTrace/integrators/shared/SampledLights.h"

#include <cmath>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kSide = 8; ///< of the view [pixels]

/// Returns a white floor around the origin.
SceneBuilder whiteFloor()
{
    SceneBuilder builder;
    builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(1.0f)));
    return builder;
}

View floorView()
{
    return patchView({0, 0, 0}, {0, 0, 1}, 1e-3, kSide);
}

/// Returns the place of light number i of a field above the floor; some lights are a hundred times
/// brighter than others.
Vec3 placeOf(int i)
{
    return {0.37f * float(i % 37) - 6.5f, 0.41f * float(i % 31) - 6.0f, 2.0f + 0.1f * float(i % 7)};
}
float brightnessOf(int i)
{
    return i % 50 == 0 ? 100.0f : 1.0f;
}

std::shared_ptr<const TracedScene> underPoints(int count)
{
    SceneBuilder builder = whiteFloor();
    for (int i = 0; i < count; ++i)
        builder.addLight(pointLight(placeOf(i), Vec3(brightnessOf(i))));
    return builder.build();
}

/// Returns the radiance of the floor at the origin that the point lights cause.
double radianceOfPoints(int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; ++i)
    {
        const Vec3d p(placeOf(i));
        sum += double(brightnessOf(i)) * p.z / std::pow(glm::length(p), 3.0);
    }
    return sum;
}

std::shared_ptr<const TracedScene> underSquares(int count)
{
    SceneBuilder builder = whiteFloor();
    for (int i = 0; i < count; ++i)
        builder.addQuadLight(placeOf(i), {0, 0.01f, 0}, {0.01f, 0, 0},
                             Vec3(1e4f * brightnessOf(i)));
    return builder.build();
}

/// Returns the radiance that the squares cause. They are so far away that they count as points to
/// an accuracy of 1e-3.
double radianceOfSquares(int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; ++i)
    {
        const Vec3d p = Vec3d(placeOf(i)) + Vec3d(0.005, 0.005, 0.0);
        sum +=
            1e4 * double(brightnessOf(i)) * 1e-4 * p.z * p.z / std::pow(glm::length(p), 4.0) / M_PI;
    }
    return sum;
}

double shadowRaysAPixel(const Picture& picture)
{
    return double(picture.progress.rays.shadow) / double(picture.progress.rays.camera);
}

} // namespace

TEST_CASE("many lights: a pass takes a bounded number of samples", "[integrators]")
{
    const View view = floorView();
    for (const int samples : {1, 4, 9})
    {
        RenderOptions options = optionsOf(IntegratorKind::Whitted);
        options.lightSamples = samples;
        for (const auto& traced : {underSquares(3000), underPoints(3000)})
            CHECK(shadowRaysAPixel(render(traced, view, options, 1)) == 4.0 * samples);
    }
    CHECK(shadowRaysAPixel(
              render(underPoints(3000), view, optionsOf(IntegratorKind::Path, 2), 1)) == 4.0);
}

TEST_CASE("many lights: up to the bound each light has all of its samples", "[integrators]")
{
    const View view = floorView();
    const RenderOptions options = optionsOf(IntegratorKind::Whitted);
    CHECK(shadowRaysAPixel(render(underSquares(32), view, options, 1)) == 32.0 * 4.0);
    CHECK(shadowRaysAPixel(render(underSquares(33), view, options, 1)) == 16.0);
    CHECK(shadowRaysAPixel(render(underPoints(32), view, options, 1)) == 32.0);
    CHECK(shadowRaysAPixel(render(underPoints(33), view, options, 1)) == 16.0);

    RenderOptions cells = options; // numbers of stratified samples are squares
    cells.lightSampling = LightSampling::Stratified;
    CHECK(samplesOfEach(cells, 64) == 4);
    CHECK(samplesOfEach(cells, 100) == 1);
    cells.lightSamples = 36;
    CHECK(samplesOfEach(cells, 100) == 16);
    CHECK(samplesOfEach(cells, 1000000) == 1);
}

TEST_CASE("many lights: the mean over passes is the light of all", "[integrators][statistics]")
{
    const int kPoints = 1500, kSquares = 1000;
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
    {
        const Estimate points = measure(underPoints(kPoints), floorView(), optionsOf(kind, 2), 4);
        CAPTURE(int(kind), points.mean(), points.standardError(), radianceOfPoints(kPoints));
        CHECK(points.agrees(radianceOfPoints(kPoints), 1e-4));
        CHECK(points.standardError() < 5e-3 * points.mean());
    }
    const Estimate squares =
        measure(underSquares(kSquares), floorView(), optionsOf(IntegratorKind::Whitted), 4);
    CAPTURE(squares.mean(), squares.standardError(), radianceOfSquares(kSquares));
    CHECK(squares.agrees(radianceOfSquares(kSquares), 1e-3 * radianceOfSquares(kSquares)));
    CHECK(squares.standardError() < 5e-3 * squares.mean());
}

TEST_CASE("many lights: the progress says how many are sampled", "[integrators]")
{
    const auto lightsOf = [](const std::shared_ptr<const TracedScene>& traced, IntegratorKind kind)
    { return render(traced, floorView(), optionsOf(kind, 2), 1).progress.lights; };
    const SampledLightCounts squares = lightsOf(underSquares(1000), IntegratorKind::Whitted);
    CHECK(squares.treeLights == 1000);
    CHECK(squares.treeSamples == 16);
    CHECK(lightsOf(underSquares(32), IntegratorKind::Whitted).treeLights == 0);
    CHECK(lightsOf(underSquares(1000), IntegratorKind::Path).treeLights == 0); // new at each point

    SceneBuilder builder = whiteFloor();
    Light sun;
    sun.kind = LightKind::Directional;
    sun.diffuse = Vec3(1.0f);
    for (int i = 0; i < 300; ++i)
        builder.addLight(sun);
    const SampledLightCounts suns = lightsOf(builder.build(), IntegratorKind::Path);
    CHECK(suns.deltaLights == 300);
    CHECK(suns.sampledDeltaLights == 256);
}

TEST_CASE("many lights: suns beside a tree of lamps all shine", "[integrators][statistics]")
{
    // Lamps come first, and more suns than a pass samples: those are chosen from their own list.
    constexpr int kLamps = 40, kSuns = 300;
    SceneBuilder builder = whiteFloor();
    for (int i = 0; i < kLamps; ++i)
        builder.addLight(pointLight(placeOf(i), Vec3(brightnessOf(i))));
    double expected = radianceOfPoints(kLamps);
    for (int i = 0; i < kSuns; ++i)
    {
        const double angle = 0.004 * i;
        Light sun;
        sun.kind = LightKind::Directional;
        sun.direction = Vec3(std::sin(angle), 0.0, -std::cos(angle));
        sun.diffuse = Vec3(i < kSuns - 10 ? 0.01f : 1.0f);
        builder.addLight(sun);
        expected += double(sun.diffuse.x) * std::cos(angle);
    }
    const std::shared_ptr<const TracedScene> traced = builder.build();
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
    {
        const Estimate light = measure(traced, floorView(), optionsOf(kind, 2), 4);
        CAPTURE(int(kind), light.mean(), light.standardError(), expected);
        CHECK(light.agrees(expected, 1e-3 * expected));
    }
}
