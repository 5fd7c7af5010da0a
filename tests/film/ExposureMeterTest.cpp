// ExposureMeterTest.cpp - the exposure of a picture's mean, and how displays follow it.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/ExposureMeter.h"
#include "osgRayTrace/film/ToneMap.h"
#include "tests/Catch.h"

#include <cmath>

using namespace osgRayTrace::engine;

namespace
{

/// Returns a film with one pass. value(x, y) is the radiance, not multiplied with alpha; what is
/// outside of the image has 1e6.
template <class Value> Film filmOf(int width, int height, float alpha, const Value& value)
{
    Film film;
    film.reset(width, height);
    film.beginPass();
    for (int tile = 0; tile < film.tileCount(); ++tile)
    {
        TileRgba values;
        for (int b = 0; b < kTileBlocks; ++b)
            for (int i = 0; i < kLanes; ++i)
            {
                const int x = film.tileX(tile) + b % 4 * 4 + i % 4;
                const int y = film.tileY(tile) + b / 4 * 4 + i / 4;
                const float radiance = x < width && y < height ? value(x, y) : 1e6f;
                values[b].r[i] = values[b].g[i] = values[b].b[i] = alpha * radiance;
                values[b].a[i] = radiance == 0.0f ? 0.0f : alpha;
            }
        film.addPass(tile, 0, values);
    }
    return film;
}

} // namespace

TEST_CASE("exposure meter: the mean of logarithms becomes middle grey", "[film]")
{
    const auto checks = [](int x, int y) { return (x + y) % 2 ? 0.5f : 8.0f; }; // their mean: 2
    for (const float alpha : {1.0f, 0.25f})
    {
        const auto reading = meteredEv(filmOf(50, 34, alpha, checks), false, 1000);
        REQUIRE(reading);
        CHECK(*reading == Approx(std::log2(0.18 / 2.0)).epsilon(1e-5));
    }
    // Black does not count, and display values are decoded.
    const auto half = [](int x, int) { return x < 25 ? 0.5f : 0.0f; };
    CHECK(*meteredEv(filmOf(50, 34, 1.0f, half), false, 1000) ==
          Approx(std::log2(0.18 / 0.5)).epsilon(1e-5));
    CHECK(*meteredEv(filmOf(50, 34, 1.0f, half), true, 1000) ==
          Approx(std::log2(0.18 / double(linearFromSrgb(0.5f)))).epsilon(1e-5));
    // Of two halves of 4096 and 1 the dark one counts as a 64th of their mean.
    const auto deep = [](int x, int) { return x < 32 ? 4096.0f : 1.0f; };
    CHECK(*meteredEv(filmOf(64, 64, 1.0f, deep), false, 1000) ==
          Approx(std::log2(0.18 / std::sqrt(4096.0 * 2048.5 / 64.0))).epsilon(1e-5));
    // Few tiles are spread over the image.
    const auto steps = [](int x, int) { return x < 64 ? 1.0f : 4.0f; };
    CHECK(*meteredEv(filmOf(128, 128, 1.0f, steps), false, 16) ==
          Approx(std::log2(0.18 / 2.0)).epsilon(1e-5));
}

TEST_CASE("exposure meter: black and empty pictures have no reading, extreme ones a limit",
          "[film]")
{
    CHECK_FALSE(meteredEv(filmOf(20, 20, 1.0f, [](int, int) { return 0.0f; }), false, 10));
    CHECK_FALSE(meteredEv(Film(), false, 10));
    CHECK(*meteredEv(filmOf(20, 20, 1.0f, [](int, int) { return 1e12f; }), false, 10) == -16.0f);
}

TEST_CASE("exposure meter: displays follow in steps, and stand still under noise", "[film]")
{
    EasedExposure exposure;
    CHECK(exposure.follow(3.0f) == 3.0f); // the first picture is right at once
    CHECK(exposure.follow(3.1f) == 3.0f);
    CHECK(exposure.follow(2.9f) == 3.0f);
    float before = 3.0f;
    int steps = 0;
    for (; steps < 100; ++steps)
    {
        const float now = exposure.follow(5.0f);
        if (now == before) break;
        CHECK(now > before);
        CHECK(now - before <= EasedExposure::kStep * (5.0f - before) + 1e-6f);
        before = now;
    }
    CHECK(steps < 30);
    CHECK(before == Approx(5.0f).margin(0.02));
    CHECK(exposure.follow(5.1f) == before);
    exposure.reset();
    CHECK(exposure.follow(-1.0f) == -1.0f);
}
