// SobolTest.cpp - the Owen-scrambled points form nets, whatever the seed.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/sampling/Sobol.h"

#include <set>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

struct Point
{
    float x, y;
};

std::vector<Point> points(uint32_t first, uint32_t count, uint32_t seed)
{
    std::vector<Point> result(count);
    for (uint32_t i = 0; i < count; ++i)
        sobol2(first + i, seed, result[i].x, result[i].y);
    return result;
}

/// Returns whether each elementary interval of area 2^-k holds exactly one of the 2^k points.
bool isNet(const std::vector<Point>& points, int k)
{
    for (int bitsX = 0; bitsX <= k; ++bitsX)
    {
        std::vector<bool> taken(points.size(), false);
        for (const Point& p : points)
        {
            const auto column = static_cast<std::size_t>(std::ldexp(p.x, bitsX));
            const auto row = static_cast<std::size_t>(std::ldexp(p.y, k - bitsX));
            const std::size_t cell = (row << bitsX) | column;
            if (taken[cell]) return false;
            taken[cell] = true;
        }
    }
    return true;
}

} // namespace

TEST_CASE("sobol2: each power of two of points is a (0,k,2)-net, for every seed", "[sampling]")
{
    for (uint32_t seed = 0; seed < 200; ++seed)
    {
        CAPTURE(seed);
        for (int k = 0; k <= 10; ++k)
        {
            CAPTURE(k);
            REQUIRE(isNet(points(0, 1u << k, hash(seed)), k));
        }
    }
}

TEST_CASE("sobol2: each aligned block of the sequence is a net of its own", "[sampling]")
{
    // So an image may go on from any pass, and each pass of n samples is stratified by itself.
    for (uint32_t seed = 0; seed < 50; ++seed)
    {
        for (int k = 0; k <= 8; ++k)
        {
            for (uint32_t block = 0; block < 5; ++block)
            {
                CAPTURE(seed, k, block);
                REQUIRE(isNet(points(block << k, 1u << k, hash(seed)), k));
            }
        }
    }
}

TEST_CASE("sobol2: points stay in [0,1) far along the sequence", "[sampling]")
{
    for (const uint32_t first : {0u, 0x7fffff00u, 0xffffff00u})
    {
        for (const uint32_t seed : {0u, 1u, 0xffffffffu, 12345u})
        {
            for (const Point& p : points(first, 256, seed))
            {
                REQUIRE((p.x >= 0.0f && p.x < 1.0f));
                REQUIRE((p.y >= 0.0f && p.y < 1.0f));
            }
        }
    }
}

TEST_CASE("sobol1: the first coordinate of sobol2", "[sampling]")
{
    for (uint32_t i = 0; i < 1000; ++i)
    {
        float x, y;
        sobol2(i, 77u, x, y);
        REQUIRE(sobol1(i, 77u) == x);
    }
}

TEST_CASE("sobol2: over seeds each point is uniform on the square", "[sampling][statistics]")
{
    // These are chi-square tests on 32 x 32 cells for points of several numbers, with 1 % false
    // alarms in all.
    constexpr int kSide = 32;
    const std::vector<uint32_t> indices{0, 1, 2, 3, 17, 100, 65535};
    constexpr uint32_t kSeeds = 100000;
    for (const uint32_t index : indices)
    {
        std::vector<double> counts(kSide * kSide, 0.0);
        for (uint32_t s = 0; s < kSeeds; ++s)
        {
            float x, y;
            sobol2(index, hash(s), x, y);
            ++counts[static_cast<std::size_t>(y * kSide) * kSide +
                     static_cast<std::size_t>(x * kSide)];
        }
        const std::vector<double> expected(counts.size(), double(kSeeds) / (kSide * kSide));
        CAPTURE(index);
        CHECK(chiSquareTest(counts, expected) > sidak(0.01, static_cast<int>(indices.size())));
    }
}

TEST_CASE("sobol2: sequences of different seeds are uncorrelated", "[sampling][statistics]")
{
    // The points have the same index and neighbouring raw seeds: the correlation of their
    // coordinates over 2^16 pairs is below 4.5 / sqrt(n). There are 4 tests, with a false alarm in
    // 3e5.
    constexpr int kPairs = 1 << 16;
    double sums[4] = {};
    for (uint32_t i = 0; i < kPairs; ++i)
    {
        float x0, y0, x1, y1;
        sobol2(i % 16, hash(i), x0, y0);
        sobol2(i % 16, hash(i + 1), x1, y1);
        const double a = x0 - 0.5, b = y0 - 0.5, c = x1 - 0.5, d = y1 - 0.5;
        sums[0] += a * c;
        sums[1] += a * d;
        sums[2] += b * c;
        sums[3] += b * d;
    }
    for (const double sum : sums)
        CHECK(std::abs(sum * 12.0) < 4.5 * std::sqrt(double(kPairs)));
}

TEST_CASE("sobol2: reference points of an unscrambled sequence have the second matrix of Sobol",
          "[sampling]")
{
    // The first coordinates are the reversed bits of 0..7 in base 2, the second ones 0, 1/2, 3/4,
    // 1/4, 5/8, 1/8, 3/8, 7/8.
    const double second[] = {0.0, 0.5, 0.75, 0.25, 0.625, 0.125, 0.375, 0.875};
    for (uint32_t i = 0; i < 8; ++i)
        CHECK(reverseBits(sobolSecondReversed(i)) * 0x1p-32 == second[i]);
    CHECK(reverseBits(1u) == 0x80000000u);
    CHECK(reverseBits(0x12345678u) == 0x1e6a2c48u);
}
