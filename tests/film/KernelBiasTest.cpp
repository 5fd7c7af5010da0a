// KernelBiasTest.cpp - the bias of discs from the differences between them.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/film/KernelBias.h"

#include <set>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns the squared bias that is stated for an image of tiles whose discs of radius r, r / 2 and
/// r / 4 have a bias of 1, ratio and ratio^2, with noise of this deviation in each difference.
double statedBias(double ratio, double noise, int tiles, int passes, uint32_t seed)
{
    Uniform random(seed);
    std::vector<BiasProducts> products;
    for (int tile = 0; tile < tiles; ++tile)
    {
        DiscDifferences differences;
        for (int pass = 0; pass < passes; ++pass)
        {
            Vec3 added[kComparedDiscs][kLanes];
            for (int disc = 0; disc < kComparedDiscs; ++disc)
                for (Vec3& value : added[disc])
                    value = Vec3(static_cast<float>((1.0 - ratio) * std::pow(ratio, disc) +
                                                    noise * std::sqrt(12.0) * (random() - 0.5)));
            differences.add(pass, added);
        }
        products.push_back(biasProducts(differences, passes, Vec3d(0.5, 0.25, 0.25)));
    }
    return squaredBias(products, std::vector<double>(products.size(), 1.0)) / tiles;
}

} // namespace

TEST_CASE("kernel bias: the sum of the series of smaller discs", "[film]")
{
    for (const int passes : {2, 3, 7, 8, 31, 64})
        for (const double ratio : {0.25, 0.5, 0.7})
        {
            CAPTURE(passes, ratio);
            CHECK(statedBias(ratio, 0.0, 5, passes, 1) == Approx(1.0).epsilon(1e-5));
        }
}

// The products of 400 tiles, 64 pixels and 32 passes have a standard error of 1 % of the squared
// difference, the ratio one of 3 %: the bias is right to a tenth, five standard errors.
TEST_CASE("kernel bias: noise that is greater than the bias averages out", "[film][statistics]")
{
    CHECK(statedBias(0.5, 2.0, 400, 64, 2) == Approx(1.0).epsilon(0.1));
}

// Blocks are taken to be of the same photons, which is 16 times the variance of these pixels: noise
// alone is eight standard errors below the bound.
TEST_CASE("kernel bias: noise alone is no bias", "[film][statistics]")
{
    double stated = 0.0;
    for (uint32_t seed = 0; seed < 20; ++seed)
    {
        Uniform random(seed);
        std::vector<BiasProducts> products;
        for (int tile = 0; tile < 20; ++tile)
        {
            DiscDifferences differences;
            for (int pass = 0; pass < 16; ++pass)
            {
                Vec3 added[kComparedDiscs][kLanes];
                for (auto& disc : added)
                    for (Vec3& value : disc)
                        value = Vec3(random() - 0.5f);
                differences.add(pass, added);
            }
            products.push_back(biasProducts(differences, 16, Vec3d(1.0)));
        }
        stated += squaredBias(products, std::vector<double>(products.size(), 1.0));
    }
    CHECK(stated == 0.0);
}

TEST_CASE("kernel bias: compared blocks are in different rows and columns of the tile", "[film]")
{
    for (int tile = 0; tile < 100; ++tile)
    {
        std::set<int> rows, columns;
        for (int pass = 0; pass < 8; pass += 2)
        {
            const int block = comparedBlock(tile, pass);
            CHECK(block == comparedBlock(tile, pass + 1)); // both halves have the same blocks
            CHECK(block == comparedBlock(tile, pass + 8));
            CHECK(block >= 0);
            CHECK(block < kTileBlocks);
            rows.insert(block / 4);
            columns.insert(block % 4);
        }
        CHECK(rows.size() == 4);
        CHECK(columns.size() == 4);
    }
}

// Discs of 400 pixels have a bias of 1 and differ from footprints by a noise of 3 a pass, over 16
// passes: the sum of squares has a standard error of 9 %, sqrt((2 (9 / 16)^2 + 4 * 9 / 16) / 400).
// Noise alone is never more than the four standard errors that are asked for, in 20 tries.
TEST_CASE("kernel bias: what footprints tell of discs", "[film][statistics]")
{
    constexpr int kPasses = 16, kPixels = 400;
    const auto squared = [](double bias, uint32_t seed)
    {
        Uniform random(seed);
        FootprintBias tile;
        for (int pixel = 0; pixel < kPixels; ++pixel)
        {
            double sum = 0.0, squares = 0.0;
            for (int pass = 0; pass < kPasses; ++pass)
            {
                const double difference = bias + 3.0 * std::sqrt(12.0) * (random() - 0.5);
                sum += difference;
                squares += difference * difference;
            }
            tile.addPixel(kPasses, sum, squares, 0.5);
        }
        return squaredBias(std::vector<FootprintBias>{tile}, {1.0}) / kPixels;
    };
    CHECK(squared(1.0, 1) == Approx(0.25).epsilon(0.28));
    for (uint32_t seed = 2; seed < 22; ++seed)
        CHECK(squared(0.0, seed) == 0.0);
    FootprintBias few;
    few.addPixel(1, 5.0, 25.0, 1.0); // one pass tells nothing
    CHECK(few.squares == 0.0);
}
