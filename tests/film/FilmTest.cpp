// FilmTest.cpp - means, halves and the error estimate of the accumulated image.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/base/Status.h"
#include "osgRayTrace/film/ErrorEstimate.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Sets all channels and pixels of a tile to value(pixel, channel).
template <class Value> void fill(TileRgba& tile, const Value& value)
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        for (int i = 0; i < kLanes; ++i)
        {
            const int pixel = b * kLanes + i;
            tile[b].r[i] = value(pixel, 0);
            tile[b].g[i] = value(pixel, 1);
            tile[b].b[i] = value(pixel, 2);
            tile[b].a[i] = value(pixel, 3);
        }
    }
}

void addConstant(Film& film, int tile, float value)
{
    TileRgba values;
    fill(values, [value](int, int) { return value; });
    film.beginPass();
    film.addPass(tile, film.tilePasses(tile), values);
}

} // namespace

TEST_CASE("film: a new one is transparent black and has no passes", "[film]")
{
    Film film;
    CHECK(film.passes() == 0);
    film.reset(20, 5);
    CHECK(film.width() == 20);
    CHECK(film.height() == 5);
    CHECK(film.tileCount() == 2);
    CHECK(film.passes() == 0);
    TileRgba mean;
    film.mean(1, mean);
    CHECK(mean[3].r[5] == 0.0f);
    CHECK(mean[3].a[5] == 0.0f);
}

TEST_CASE("film: tiles cover the image, the last ones partly", "[film]")
{
    Film film;
    film.reset(33, 17);
    CHECK(film.tileCount() == 6);
    CHECK(film.tileX(2) == 32);
    CHECK(film.tileY(2) == 0);
    CHECK(film.tileX(3) == 0);
    CHECK(film.tileY(3) == 16);
}

TEST_CASE("film: an image of more than 2^28 pixels is refused", "[film]")
{
    Film film;
    REQUIRE_THROWS_AS(film.reset(1 << 15, (1 << 13) + 1), EngineError);
    CHECK(film.width() == 0);
}

TEST_CASE("film: tiles count their passes apart, reset clears them", "[film]")
{
    Film film;
    film.reset(32, 16);
    addConstant(film, 0, 3.0f);
    CHECK(film.tilePasses(0) == 1);
    CHECK(film.tilePasses(1) == 0);
    CHECK(film.passes() == 0);
    addConstant(film, 1, 5.0f);
    CHECK(film.passes() == 1);
    TileRgba mean;
    film.mean(0, mean);
    CHECK(mean[0].r[0] == 3.0f);
    film.reset(32, 16);
    CHECK(film.passes() == 0);
    addConstant(film, 0, 7.0f);
    film.mean(0, mean);
    CHECK(mean[0].r[0] == 7.0f); // nothing is left of the first image
}

TEST_CASE("film: even passes make the first half, odd ones the second", "[film]")
{
    Film film;
    film.reset(16, 16);
    for (int pass = 0; pass < 5; ++pass)
        addConstant(film, 0, static_cast<float>(1 << pass)); // 1 4 16 | 2 8
    TileRgba first, second, mean;
    film.halfMeans(0, first, second);
    film.mean(0, mean);
    CHECK(first[2].g[7] == 7.0f);
    CHECK(second[2].g[7] == 5.0f);
    CHECK(mean[2].g[7] == Approx(31.0 / 5.0));
}

TEST_CASE("film: the mean of any number of passes, across the folding into totals", "[film]")
{
    Film film;
    film.reset(16, 16);
    for (int pass = 0; pass < 700; ++pass)
    {
        addConstant(film, 0, static_cast<float>(pass));
        TileRgba mean, first, second;
        film.mean(0, mean);
        film.halfMeans(0, first, second);
        CAPTURE(pass);
        REQUIRE(mean[9].b[3] == Approx(0.5 * pass).epsilon(1e-6));
        const int lastEven = pass - pass % 2, lastOdd = pass - 1 + pass % 2;
        REQUIRE(first[9].b[3] == Approx(0.5 * lastEven).epsilon(1e-6));
        if (pass > 0) REQUIRE(second[9].b[3] == Approx(0.5 * (1 + lastOdd)).epsilon(1e-6));
    }
}

TEST_CASE("film: a million passes keep their mean to 1e-6", "[film][stability 38]")
{
    // The samples are a constant that float cannot sum exactly, then a uniform stream, which is
    // compared with its sum in double.
    Film film;
    film.reset(16, 16);
    Uniform random(3);
    double sum = 0.0;
    TileRgba tile;
    fill(tile, [](int, int channel) { return channel == 0 ? 0.1f : 0.0f; });
    for (int pass = 0; pass < 1000000; ++pass)
    {
        const float value = random();
        sum += value;
        tile[0].g[0] = value;
        film.beginPass();
        film.addPass(0, film.tilePasses(0), tile);
    }
    TileRgba mean;
    film.mean(0, mean);
    CHECK(std::abs(mean[0].r[0] - 0.1) < 1e-6 * 0.1);
    CHECK(std::abs(mean[15].r[15] - 0.1) < 1e-6 * 0.1);
    CHECK(std::abs(mean[0].g[0] - sum / 1e6) < 1e-6 * 0.5);
}

TEST_CASE("film: the error estimate is the true error on average", "[film][statistics]")
{
    // The noise is nearly Gaussian (a sum of 4 uniform variables) and of known mean. There are 100
    // seeds, and numbers of passes that are odd or fold the sums. The relative spread of the ratio
    // over seeds is below 0.5 %.
    const float reference = 2.0f;
    for (const int passes : {2, 3, 5, 16, 300})
    {
        double estimated = 0.0, actual = 0.0;
        for (uint32_t seed = 0; seed < 100; ++seed)
        {
            Uniform random(seed);
            Film film;
            film.reset(16, 16);
            TileRgba tile;
            for (int pass = 0; pass < passes; ++pass)
            {
                fill(tile, [&](int, int) { return random() + random() + random() + random(); });
                film.beginPass();
                film.addPass(0, film.tilePasses(0), tile);
            }
            const double error = estimateError(film, Workers(1)).relative;
            estimated += error * error;
            TileRgba mean;
            film.mean(0, mean);
            for (const RgbaLanes& block : mean)
            {
                for (int i = 0; i < kLanes; ++i)
                {
                    for (const float value : {block.r[i], block.g[i], block.b[i]})
                        actual += double(value - reference) * (value - reference) /
                                  (reference * reference + 0.01) / (3.0 * kTilePixels);
                }
            }
        }
        CAPTURE(passes);
        CHECK(std::sqrt(estimated / actual) == Approx(1.0).margin(0.02));
    }
}

TEST_CASE("film: the error estimate leaves out pixels beyond the image", "[film]")
{
    Film film;
    film.reset(3, 2);
    TileRgba tile;
    for (int pass = 0; pass < 2; ++pass)
    {
        fill(tile, [pass](int pixel, int)
             { return pixel == 15 ? 1000.0f * static_cast<float>(pass) : 1.0f; });
        film.beginPass();
        film.addPass(0, film.tilePasses(0), tile);
    }
    const ErrorEstimate error = estimateError(film, Workers(1));
    CHECK(error.relative == 0.0);
    CHECK(error.median == 0.0);
    CHECK(error.worstShare == 0.0);
}
