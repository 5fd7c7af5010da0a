// UniformityTest.cpp - points of every strategy are uniform over pixels, passes and dimensions,
// alone and in pairs.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/sampling/LightPoints.h"
#include "osgRayTrace/sampling/Sampler.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kSide = 32;
constexpr uint32_t kPixels = 1024; ///< a side of the image that points are taken from

/// Returns the probability of counts this uneven over kSide x kSide cells of the square, with one
/// point a pixel.
template <class Point> double fitOf(const Point& pointOf)
{
    std::vector<double> counts(kSide * kSide, 0.0);
    int outside = 0;
    for (uint32_t y = 0; y < kPixels; ++y)
    {
        for (uint32_t x = 0; x < kPixels; ++x)
        {
            float u, v;
            pointOf(x, y, u, v);
            outside += !(u >= 0.0f && u < 1.0f && v >= 0.0f && v < 1.0f);
            const int cell = int(v * kSide) * kSide + int(u * kSide);
            ++counts[static_cast<std::size_t>(cell)];
        }
    }
    CHECK(outside == 0);
    return chiSquareTest(
        counts, std::vector<double>(counts.size(), double(kPixels) * kPixels / (kSide * kSide)));
}

} // namespace

// The tests are chi-square tests on 1024 cells of 1024 points each, with 1 % false alarms in all
// tests of a case (Sidak).

TEST_CASE("uniformity: each dimension and pass of the pixels' Sobol points",
          "[sampling][statistics]")
{
    const uint32_t dimensions[] = {DimensionPixel, bounceDimension(0, DimensionLightPoint),
                                   bounceDimension(0, DimensionBsdfDirection),
                                   bounceDimension(7, DimensionBsdfLobe)};
    for (const uint32_t dimension : dimensions)
    {
        for (const int pass : {0, 1, 2, 7, 1000})
        {
            const PassKey key = passKey(3, pass);
            CAPTURE(dimension, pass);
            CHECK(fitOf(
                      [&](uint32_t x, uint32_t y, float& u, float& v) {
                          sobol2(key.index, dimensionSeed(pixelSeed(key, x, y), dimension), u, v);
                      }) > sidak(0.01, 20));
        }
    }
}

TEST_CASE("uniformity: points within the pixels, of each pass", "[sampling][statistics]")
{
    for (const int pass : {0, 1, 2, 7, 1000})
    {
        const PassKey key = passKey(4, pass);
        CAPTURE(pass);
        CHECK(fitOf(
                  [&](uint32_t x, uint32_t y, float& u, float& v)
                  {
                      const uint32_t seed = dimensionSeed(pixelSeed(key, x, y), DimensionPixel);
                      sobol2Ordered(key.index, seed, u, v);
                  }) > sidak(0.01, 5));
    }
}

TEST_CASE("uniformity: pairs of dimensions, of passes, of halves and of neighbours",
          "[sampling][statistics]")
{
    // One number must tell nothing about the other.
    const auto first = [](uint32_t seed, int pass, uint32_t x, uint32_t y, uint32_t dimension)
    {
        const PassKey key = passKey(seed, pass);
        float u, v;
        sobol2(key.index, dimensionSeed(pixelSeed(key, x, y), dimension), u, v);
        return u;
    };
    struct Pair
    {
        const char* name;
        uint32_t seed;
        int pass;
        uint32_t dx, dimension;
    };
    // Each row is a partner of (seed 5, pass 4, pixel, dimension 0). Passes of one half are
    // stratified against each other: they are not independent, and not among the rows.
    const Pair pairs[] = {
        {"next dimension", 5, 4, 0, 1}, {"next bounce", 5, 4, 0, kDimensionsPerBounce},
        {"other half", 5, 5, 0, 0},     {"other half, other pass", 5, 7, 0, 0},
        {"next pixel", 5, 4, 1, 0},     {"next seed", 6, 4, 0, 0}};
    for (const Pair& pair : pairs)
    {
        CAPTURE(pair.name);
        CHECK(fitOf(
                  [&](uint32_t x, uint32_t y, float& u, float& v)
                  {
                      u = first(5, 4, x, y, 0);
                      v = first(pair.seed, pair.pass, x + pair.dx, y, pair.dimension);
                  }) > sidak(0.01, 6));
    }
}

TEST_CASE("uniformity: within the cells of the jittered strategies, and of random points",
          "[sampling][statistics]")
{
    for (const uint32_t n : {1u, 3u, 8u})
    {
        const auto within = [n](uint32_t j, float& u, float& v)
        {
            // Rounding may put a point on the edge of the next cell.
            u = std::clamp(u * float(n) - float(j % n), 0.0f, kOneMinusEpsilon);
            v = std::clamp(v * float(n) - float(j / n), 0.0f, kOneMinusEpsilon);
        };
        for (const uint32_t pass : {0u, 5u})
        {
            CAPTURE(n, pass);
            const uint32_t j = n * n - 1;
            const PassKey key = passKey(9, 2);
            CHECK(fitOf(
                      [&](uint32_t x, uint32_t y, float& u, float& v)
                      {
                          uniformJitter2(j, n, pass, pixelSeed(key, x, y), u, v);
                          within(j, u, v);
                      }) > sidak(0.01, 18));
            CHECK(fitOf(
                      [&](uint32_t x, uint32_t y, float& u, float& v)
                      {
                          stratified2(j, n, pass, pixelSeed(key, x, y), u, v);
                          within(j, u, v);
                      }) > sidak(0.01, 18));
            CHECK(fitOf([&](uint32_t x, uint32_t y, float& u, float& v)
                        { random2(pass * n, pixelSeed(key, x, y), u, v); }) > sidak(0.01, 18));
        }
    }
}
