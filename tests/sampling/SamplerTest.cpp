// SamplerTest.cpp - random numbers depend on their key alone, and keys neither collide nor
// correlate.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/sampling/LightPoints.h"
#include "osgRayTrace/sampling/Sampler.h"

#include <set>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("hash: a bijection on a sample, and every output bit flips with every input bit",
          "[sampling][statistics]")
{
    std::set<uint32_t> seen;
    for (uint32_t i = 0; i < 200000; ++i)
        seen.insert(hash(i * 2654435761u));
    CHECK(seen.size() == 200000);

    // The avalanche test has 4096 trials for a pair of bits; each flip rate must be within 6 sigma
    // of 1/2.
    constexpr int kTrials = 4096;
    for (int in = 0; in < 32; ++in)
    {
        int flips[32] = {};
        for (uint32_t t = 0; t < kTrials; ++t)
        {
            const uint32_t key = t * 0x9e3779b9u;
            const uint32_t difference = hash(key) ^ hash(key ^ (1u << in));
            for (int out = 0; out < 32; ++out)
                flips[out] += (difference >> out) & 1u;
        }
        for (const int n : flips)
            REQUIRE(std::abs(n - kTrials / 2) < 6 * 32);
    }
}

TEST_CASE("unitFloat: covers [0,1) and never reaches 1", "[sampling]")
{
    CHECK(unitFloat(0u) == 0.0f);
    CHECK(unitFloat(0xffffffffu) == 1.0f - 0x1p-24f);
    CHECK(unitFloat(0x80000000u) == 0.5f);
}

TEST_CASE("sampler: passes alternate between two halves of their own", "[sampling]")
{
    CHECK(passKey(5, 0).seed == passKey(5, 2).seed);
    CHECK(passKey(5, 1).seed == passKey(5, 3).seed);
    CHECK(passKey(5, 0).seed != passKey(5, 1).seed);
    CHECK(passKey(5, 0).seed != passKey(6, 0).seed);
    CHECK(passKey(5, 0).index == 0);
    CHECK(passKey(5, 1).index == 0);
    CHECK(passKey(5, 7).index == 3);
}

TEST_CASE("sampler: pixels, dimensions and halves have seeds of their own", "[sampling]")
{
    std::set<uint32_t> seeds;
    std::size_t keys = 0;
    for (int half = 0; half < 2; ++half)
    {
        for (uint32_t y = 0; y < 64; ++y)
        {
            for (uint32_t x = 0; x < 64; ++x)
            {
                const uint32_t pixel = pixelSeed(passKey(0, half), x, y);
                for (uint32_t dimension = 0; dimension < 8; ++dimension, ++keys)
                    seeds.insert(dimensionSeed(pixel, dimension));
            }
        }
    }
    // The test maps 65,536 keys to 2^32 values: half a collision is expected by chance; 8 have a
    // probability of 1e-8.
    CHECK(seeds.size() > keys - 8);
    CHECK(pixelSeed(passKey(0, 0), 3, 7) != pixelSeed(passKey(0, 0), 7, 3));
    CHECK(bounceDimension(0, 0) == DimensionBounceFirst);
    CHECK(bounceDimension(1, DimensionBsdfDirection) > bounceDimension(0, DimensionLightChoice));
}

TEST_CASE("sampler: neighbouring pixels, dimensions and halves are uncorrelated",
          "[sampling][statistics]")
{
    // The first samples of neighbouring keys over 2^16 pixels have a correlation below 4.5 /
    // sqrt(n): a false alarm in 1.5e5 for each of 4 tests.
    constexpr uint32_t kSide = 256;
    double sums[4] = {};
    const auto value = [](int pass, uint32_t x, uint32_t y, uint32_t dimension)
    {
        float u, v;
        const PassKey key = passKey(1, pass);
        sobol2(key.index, dimensionSeed(pixelSeed(key, x, y), dimension), u, v);
        return u - 0.5;
    };
    for (uint32_t y = 0; y < kSide; ++y)
    {
        for (uint32_t x = 0; x < kSide; ++x)
        {
            const double here = value(0, x, y, 2);
            sums[0] += here * value(0, x + 1, y, 2);
            sums[1] += here * value(0, x, y + 1, 2);
            sums[2] += here * value(0, x, y, 3);
            sums[3] += here * value(1, x, y, 2);
        }
    }
    for (const double sum : sums)
        CHECK(std::abs(sum * 12.0) < 4.5 * kSide);
}

TEST_CASE("light points: jittered strategies put one sample into each cell", "[sampling]")
{
    for (uint32_t pass = 0; pass < 3; ++pass)
    {
        for (const uint32_t n : {1u, 2u, 5u})
        {
            std::set<std::pair<int, int>> uniform, stratified;
            float firstX = 0.0f, firstY = 0.0f;
            for (uint32_t j = 0; j < n * n; ++j)
            {
                float x, y;
                const auto cell = [&] { return std::make_pair(int(x * n), int(y * n)); };
                stratified2(j, n, pass, 99u, x, y);
                REQUIRE((x < 1.0f && y < 1.0f));
                stratified.insert(cell());
                uniformJitter2(j, n, pass, 99u, x, y);
                REQUIRE((x < 1.0f && y < 1.0f));
                uniform.insert(cell());
                const float offsetX = x * n - std::floor(x * n),
                            offsetY = y * n - std::floor(y * n);
                if (j == 0)
                {
                    firstX = offsetX;
                    firstY = offsetY;
                }
                CHECK(offsetX == Approx(firstX).margin(1e-5));
                CHECK(offsetY == Approx(firstY).margin(1e-5));
            }
            CHECK(uniform.size() == n * n);
            CHECK(stratified.size() == n * n);
        }
    }
}

TEST_CASE("light points: passes take new offsets", "[sampling]")
{
    float x0, y0, x1, y1;
    uniformJitter2(0, 2, 0, 5u, x0, y0);
    uniformJitter2(0, 2, 1, 5u, x1, y1);
    CHECK(x0 != x1);
    stratified2(0, 2, 0, 5u, x0, y0);
    stratified2(0, 2, 1, 5u, x1, y1);
    CHECK(x0 != x1);
}
