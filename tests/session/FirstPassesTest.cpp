// FirstPassesTest.cpp - passes that replace the first ones of an image. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/session/FirstPasses.h"

#include <cmath>
#include <vector>

using namespace osgRayTrace::engine;

namespace
{

/// Returns the light of a tile in a pass: another value in each pass, pixel and component.
std::vector<RgbaLanes> lightOf(std::size_t tile, int pass)
{
    std::vector<RgbaLanes> light(kTileBlocks);
    for (int b = 0; b < kTileBlocks; ++b)
        for (int i = 0; i < kLanes; ++i)
        {
            const auto pixel = static_cast<float>(b * kLanes + i);
            const float value = 1.0f + std::sin(pixel + 100.0f * static_cast<float>(pass) +
                                                7.0f * static_cast<float>(tile));
            light[std::size_t(b)].r[i] = value;
            light[std::size_t(b)].g[i] = 2.0f * value + 0.5f;
            light[std::size_t(b)].b[i] = 3.0f * value * value;
            light[std::size_t(b)].a[i] = 1.0f;
        }
    return light;
}

} // namespace

TEST_CASE("first passes: nothing is left of them in either half after as many further passes",
          "[session]")
{
    FirstPasses first;
    CHECK(first.empty());
    first.reset(3);
    CHECK(!first.empty());
    for (std::size_t tile = 0; tile < 3; ++tile)
    {
        std::vector<RgbaLanes> halves[2], wanted[2];
        for (int half = 0; half < 2; ++half)
        {
            halves[half].resize(kTileBlocks, RgbaLanes{});
            wanted[half].resize(kTileBlocks, RgbaLanes{});
        }
        for (int pass = 0; pass < 2 * FirstPasses::kCount; ++pass)
        {
            std::vector<RgbaLanes> light = lightOf(tile, pass);
            const std::vector<RgbaLanes> own = light;
            if (pass < FirstPasses::kCount)
            {
                first.add(tile, pass, light.data());
                first.add(tile, pass, lightOf(tile, 99).data()); // made again: it counts once
            }
            else
                first.replace(tile, pass, light.data());
            for (std::size_t b = 0; b < kTileBlocks; ++b)
                for (int i = 0; i < kLanes; ++i)
                {
                    const float twice = pass < FirstPasses::kCount ? 0.0f : 2.0f;
                    halves[pass & 1][b].r[i] += light[b].r[i];
                    halves[pass & 1][b].g[i] += light[b].g[i];
                    halves[pass & 1][b].b[i] += light[b].b[i];
                    wanted[pass & 1][b].r[i] += twice * own[b].r[i];
                    wanted[pass & 1][b].g[i] += twice * own[b].g[i];
                    wanted[pass & 1][b].b[i] += twice * own[b].b[i];
                    CHECK(light[b].a[i] == 1.0f);
                }
        }
        double largest = 0.0;
        for (int half = 0; half < 2; ++half)
            for (std::size_t b = 0; b < kTileBlocks; ++b)
                for (int i = 0; i < kLanes; ++i)
                {
                    const RgbaLanes &sum = halves[half][b], &all = wanted[half][b];
                    for (const float off :
                         {sum.r[i] - all.r[i], sum.g[i] - all.g[i], sum.b[i] - all.b[i]})
                        largest = std::max(largest, double(std::abs(off)));
                }
        CHECK(largest < 1e-4); // rounding; values are up to 24
    }
}

TEST_CASE("first passes: a pass stays as it is if one of the first is missing", "[session]")
{
    FirstPasses first;
    first.reset(1);
    for (const int pass : {0, 1, 3})
        first.add(0, pass, lightOf(0, pass).data());
    std::vector<RgbaLanes> light = lightOf(0, 4);
    first.replace(0, 4, light.data());
    CHECK(light[0].r[0] == lightOf(0, 4)[0].r[0]);
}
