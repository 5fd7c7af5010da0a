// SpecularTest.cpp - mirrors and glass.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a room of radiance 1 around a box. Unlike the facets of a sphere, a box never traps
/// light for long.
std::shared_ptr<const TracedScene> inWhiteRoom(const Material& material, bool sampled)
{
    SceneBuilder builder;
    const auto room = boxMesh(Vec3(-3.0f), Vec3(3.0f));
    if (sampled)
        builder.addEmissive(room, lamp(Vec3(1.0f)));
    else
        builder.add(room, lamp(Vec3(1.0f)));
    builder.add(boxMesh({-0.9f, -0.8f, -0.7f}, {0.9f, 0.8f, 0.7f}), material);
    return builder.build();
}

View outside()
{
    return perspectiveView({1.4, -2.1, 0.9}, {0, 0, 0}, {0, 0, 1}, 50.0, 48, 48);
}

/// Returns the largest difference of any channel of any pixel.
float largestDifference(const Picture& a, const Picture& b)
{
    float largest = 0.0f;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        largest = std::max(largest, std::abs(a.rgba[i] - b.rgba[i]));
    return largest;
}

} // namespace

TEST_CASE("glass: a clear body in a white room cannot be seen", "[integrators][statistics][long]")
{
    for (const float ior : {1.5f, 1.0f, 1.0f + 1.2e-7f, 1.0f / 1.5f, 2.4f})
    {
        for (const bool sampled : {false, true})
        {
            const Estimate radiance = measure(inWhiteRoom(glass(ior), sampled), outside(),
                                              optionsOf(IntegratorKind::Path, 100), 16);
            CAPTURE(ior, sampled, radiance.mean(), radiance.standardError());
            CHECK(radiance.agrees(1.0, 1e-4));
        }
    }
}

TEST_CASE("glass: without chance, Whitted's rays carry all energy but what cannot be seen",
          "[integrators]")
{
    const Picture picture = render(inWhiteRoom(glass(1.5f), false), outside(),
                                   optionsOf(IntegratorKind::Whitted, 100), 4);
    CHECK(picture.progress.droppedSamples == 0);
    float smallest = 2.0f, largest = 0.0f;
    for (int y = 0; y < picture.height; ++y)
    {
        for (int x = 0; x < picture.width; ++x)
        {
            smallest = std::min(smallest, picture.at(x, y).y);
            largest = std::max(largest, picture.at(x, y).y);
        }
    }
    CHECK(smallest > 0.99f); // a few rays of weights below 1/1024 end
    CHECK(largest < 1.0f + 1e-4f);
}

TEST_CASE("glass: a lamp inside it shows (1-R)/n^2 of its radiance", "[integrators][statistics]")
{
    SceneBuilder builder;
    builder.add(boxMesh(Vec3(-1.0f), Vec3(1.0f)), glass(1.5f));
    builder.add(quadMesh({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), lamp(Vec3(3.0f)));
    const View view = patchView({0, 0, 1}, {0, 0, 1}, 0.01, 16);
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        const Estimate radiance = measure(builder.build(), view, optionsOf(kind), 64);
        CAPTURE(int(kind), radiance.mean(), radiance.standardError());
        CHECK(radiance.agrees(3.0 * 0.96 / 2.25, 1e-5));
        CHECK(radiance.standardError() < 5e-3);
    }
}

TEST_CASE("rough glass: loses what single scattering loses, and makes nothing",
          "[integrators][statistics][long]")
{
    for (const float roughness : {0.1f, 0.4f})
    {
        const Estimate found = measure(inWhiteRoom(glass(1.5f, roughness), false), outside(),
                                       optionsOf(IntegratorKind::Path, 100), 4);
        const Estimate sampled = measure(inWhiteRoom(glass(1.5f, roughness), true), outside(),
                                         optionsOf(IntegratorKind::Path, 100), 8);
        CAPTURE(roughness, found.mean(), found.standardError(), sampled.mean(),
                sampled.standardError());
        CHECK(sampled.standardError() < 1e-3);
        CHECK(found.standardError() < 1e-3);
        CHECK(found.mean() < 1.0 + 4.0 * found.standardError());
        CHECK(found.mean() > (roughness < 0.2f ? 0.97 : 0.8));
        CHECK(std::abs(found.mean() - sampled.mean()) <
              4.0 * std::hypot(found.standardError(), sampled.standardError()));
    }
}

TEST_CASE("mirror: a white one in a white room cannot be seen, nor a mirror room be left",
          "[integrators][statistics]")
{
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        const Estimate radiance =
            measure(inWhiteRoom(mirror(Vec3(1.0f)), false), outside(), optionsOf(kind, 20), 4);
        CAPTURE(int(kind), radiance.mean());
        CHECK(radiance.mean() == Approx(1.0).epsilon(1e-5));
    }
}

TEST_CASE("mirror: shows the mirrored scene", "[integrators]")
{
    // Two lamps above a mirror floor are compared with two such lamps below it without the mirror.
    SceneBuilder reflected, direct;
    reflected.add(quadMesh({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), mirror(Vec3(1.0f)));
    reflected.add(quadMesh({-2, -1, 2}, {0, 2, 0}, {1.5f, 0, 0}), lamp(Vec3(1.0f, 2.0f, 3.0f)));
    reflected.add(quadMesh({0.5f, 0, 2.5f}, {0, 2, 0}, {1.5f, 0, 0}), lamp(Vec3(4.0f)));
    direct.add(quadMesh({-2, -1, -2}, {1.5f, 0, 0}, {0, 2, 0}), lamp(Vec3(1.0f, 2.0f, 3.0f)));
    direct.add(quadMesh({0.5f, 0, -2.5f}, {1.5f, 0, 0}, {0, 2, 0}), lamp(Vec3(4.0f)));
    const View view = perspectiveView({0, -3, 1.5}, {0, -0.6, -1}, {0, 0, 1}, 60.0, 64, 64);
    const Picture truth = render(direct.build(), view, optionsOf(IntegratorKind::Path), 1);
    CHECK(truth.mean().y > 0.05f);
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        // Both pictures have the same sample of each pixel: only pixels that the lamps' edges cross
        // may differ.
        const Picture picture = render(reflected.build(), view, optionsOf(kind), 1);
        int different = 0;
        for (int y = 0; y < 64; ++y)
        {
            for (int x = 0; x < 64; ++x)
                different += glm::length(picture.at(x, y) - truth.at(x, y)) > 1e-4f;
        }
        CAPTURE(int(kind));
        CHECK(different <= 2);
    }
}

TEST_CASE("mirror: a metal tints what it reflects head-on", "[integrators]")
{
    const Vec3 tint(0.9f, 0.5f, 0.25f);
    SceneBuilder builder;
    builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), mirror(tint));
    builder.add(quadMesh({-1, -1, 2}, {2, 0, 0}, {0, 2, 0}), lamp(Vec3(2.0f)));
    const View view = patchView({0, 0, 0}, {0, 0, 1}, 0.1, 8);
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
        CHECK(glm::length(render(builder.build(), view, optionsOf(kind), 1).mean() - 2.0f * tint) <
              1e-5f);
}

TEST_CASE("mirror: as roughness vanishes the image becomes the mirror's",
          "[integrators][statistics]")
{
    const auto traced = [](float roughness)
    {
        SceneBuilder builder;
        Material metal = mirror(Vec3(0.9f));
        metal.roughness = roughness;
        builder.add(quadMesh({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), metal);
        builder.add(quadMesh({-2, -1, 2}, {0, 4, 0}, {4, 0, 0}), lamp(Vec3(1.0f)));
        return builder.build();
    };
    const View view = perspectiveView({0, -3, 1.5}, {0, -0.6, -1}, {0, 0, 1}, 60.0, 32, 32);
    const RenderOptions options = optionsOf(IntegratorKind::Path);
    const Picture smooth = render(traced(0.0f), view, options, 64);
    // Returns the mean difference over the pixels, relative to the mirrored picture.
    const auto difference = [](const Picture& picture, const Picture& mirrored)
    {
        double sum = 0.0, total = 0.0;
        for (int y = 0; y < 32; ++y)
        {
            for (int x = 0; x < 32; ++x)
            {
                sum += std::abs(picture.at(x, y).y - mirrored.at(x, y).y);
                total += mirrored.at(x, y).y;
            }
        }
        return sum / total;
    };
    CHECK(largestDifference(render(traced(0.02f), view, options, 64), smooth) ==
          0.0f); // alpha is below 1e-3
    // The rough lobe uses other random numbers: the pictures are 5.4e-3 apart after 64 passes, and
    // 2.5e-3 after 1024.
    const Picture nearly = render(traced(0.035f), view, options, 1024);
    CHECK(nearly.progress.droppedSamples == 0);
    CHECK(difference(nearly, render(traced(0.0f), view, options, 1024)) < 5e-3);
    CHECK(difference(render(traced(0.5f), view, options, 64), smooth) > 0.1);
}

TEST_CASE("specular: mirrors facing each other end after maxBounces", "[integrators]")
{
    SceneBuilder builder;
    builder.add(boxMesh(Vec3(-1.0f), Vec3(1.0f)), mirror(Vec3(1.0f)));
    const View view = perspectiveView({0, 0, 0}, {0.3, 0.1, 0.9}, {0, 1, 0}, 60.0, 16, 16);
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        const Picture picture = render(builder.build(), view, optionsOf(kind, 5), 2);
        CHECK(picture.mean() == Vec3(0.0f));
        CHECK(picture.progress.rays.secondary <= uint64_t(2 * 256 * 5));
        CHECK(picture.progress.droppedSamples == 0);
    }
}

TEST_CASE("specular: no bounces are no reflections", "[integrators]")
{
    const auto traced = inWhiteRoom(mirror(Vec3(1.0f)), false);
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        const Picture picture = render(traced, outside(), optionsOf(kind, 0), 1);
        CHECK(picture.at(24, 24) == Vec3(0.0f));
        CHECK(picture.at(0, 47) == Vec3(1.0f));
        CHECK(picture.progress.rays.secondary == 0);
    }
}
