// FilmTest.cpp - sums over very many samples. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/film/Film.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("stability 38: 1e8 samples of a pixel keep their mean to 1e-6", "[stability]")
{
    // The film sums a constant that float cannot sum exactly (a float sum would stall at 2^24
    // samples), and a uniform stream, which is compared with its sum in double.
    constexpr int kSamples = 100000000;
    Film film;
    film.reset(16, 16);
    Uniform random(3);
    double sum = 0.0;
    TileRgba tile{};
    tile[0].r[0] = 0.1f;
    for (int pass = 0; pass < kSamples; ++pass)
    {
        // The stream repeats each of a thousand values: random numbers would take longer than the
        // film.
        if (pass % 100000 == 0) tile[0].g[0] = random();
        sum += tile[0].g[0];
        film.beginPass();
        film.addPass(0, film.tilePasses(0), tile);
    }
    TileRgba mean;
    film.mean(0, mean);
    CHECK(std::abs(mean[0].r[0] - 0.1) < 1e-6 * 0.1);
    CHECK(std::abs(mean[0].g[0] - sum / kSamples) < 1e-6 * 0.5);
    CHECK(film.passes() == kSamples);
}
