// DroppedSamplesTest.cpp - samples that are not numbers, or too large to be summed, are black and
// counted.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"

#include "osgRayTrace/integrators/shared/HitShading.h"

#include <limits>
#include <memory>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("dropped samples: each value and channel that is none, and no other", "[integrators]")
{
    constexpr float kInf = std::numeric_limits<float>::infinity();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const float none[] = {kNan, kInf, -kInf, std::numeric_limits<float>::max(), -1e31f};
    TileRgba rgba;
    const auto debug = std::make_unique<DebugOutputs>();
    TileResult result;
    result.rgba = rgba;
    result.debug = debug.get();
    const auto valueOf = [](int b, int i) { return static_cast<float>(1 + b * kLanes + i); };
    // Every other pixel has a bad value in one of its channels.
    uint64_t bad = 0;
    for (int b = 0; b < kTileBlocks; ++b)
    {
        for (int i = 0; i < kLanes; ++i)
        {
            RgbaLanes& block = result.rgba[b];
            block.r[i] = block.g[i] = block.b[i] = valueOf(b, i);
            block.a[i] = 0.5f;
            if ((b + i) % 2 == 0) continue;
            (bad % 3 == 0 ? block.r : bad % 3 == 1 ? block.g : block.b)[i] = none[bad % 5];
            ++bad;
        }
    }
    dropNotFinite(result);
    CHECK(result.counts.droppedSamples == bad);
    for (int b = 0; b < kTileBlocks; ++b)
    {
        for (int i = 0; i < kLanes; ++i)
        {
            const bool dropped = (b + i) % 2 != 0;
            const float expected = dropped ? 0.0f : valueOf(b, i);
            const RgbaLanes& block = result.rgba[b];
            CAPTURE(b, i);
            REQUIRE(Vec3(block.r[i], block.g[i], block.b[i]) == Vec3(expected));
            REQUIRE(block.a[i] == 0.5f);
            REQUIRE(debug->dropped[b * kLanes + i] == (dropped ? 1.0f : 0.0f));
        }
    }
}

TEST_CASE("dropped samples: a surface brighter than can be summed is black, counted and alone so",
          "[integrators]")
{
    const auto integrator = GENERATE(IntegratorKind::Whitted, IntegratorKind::Path);
    Material tooBright = lambert(Vec3(0.0f)), bright = lambert(Vec3(0.0f));
    tooBright.emission = Vec3(2e30f);
    bright.emission = Vec3(0.5f);
    SceneBuilder builder;
    builder.add(quadMesh({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}), tooBright);
    builder.add(quadMesh({0, -1, 0}, {1, 0, 0}, {0, 2, 0}), bright);
    constexpr int kPixels = 32, kPasses = 3;
    const Picture picture = render(builder.build(), patchView({0, 0, 0}, {0, 0, 1}, 2.0, kPixels),
                                   optionsOf(integrator), kPasses);
    CHECK(picture.progress.droppedSamples == kPixels * kPixels / 2 * kPasses);
    int black = 0;
    for (int y = 0; y < kPixels; ++y)
    {
        for (int x = 0; x < kPixels; ++x)
        {
            const Vec3 radiance = picture.at(x, y);
            black += radiance == Vec3(0.0f);
            if (radiance != Vec3(0.0f)) REQUIRE(radiance == Vec3(0.5f));
        }
    }
    CHECK(black == kPixels * kPixels / 2);
}
