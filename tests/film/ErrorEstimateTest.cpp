// ErrorEstimateTest.cpp - the median tile and the worst pixels of an image's error.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/ErrorEstimate.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a film of two passes whose pixels are value(pass, x, y) in all channels.
template <class Value> Film filmOf(int width, int height, const Value& value)
{
    Film film;
    film.reset(width, height);
    for (int pass = 0; pass < 2; ++pass)
    {
        film.beginPass();
        for (int tile = 0; tile < film.tileCount(); ++tile)
        {
            TileRgba values;
            for (int b = 0; b < kTileBlocks; ++b)
                for (int i = 0; i < kLanes; ++i)
                    values[b].r[i] = values[b].g[i] = values[b].b[i] = values[b].a[i] =
                        value(pass, film.tileX(tile) + laneX(b, i), film.tileY(tile) + laneY(b, i));
            film.addPass(tile, film.tilePasses(tile), values);
        }
    }
    return film;
}

/// Holds an estimate that is made pixel by pixel, with all of them sorted.
ErrorEstimate plainEstimate(int width, int height, const std::vector<float>& first,
                            const std::vector<float>& second)
{
    std::vector<double> squares, tiles;
    double sum = 0.0;
    for (int bottom = 0; bottom < height; bottom += 16)
    {
        for (int left = 0; left < width; left += 16)
        {
            std::vector<std::pair<double, double>> pixels; // mean and squared error
            double mean = 0.0, typical = 0.0;
            for (int y = bottom; y < std::min(bottom + 16, height); ++y)
            {
                for (int x = left; x < std::min(left + 16, width); ++x)
                {
                    const auto at = static_cast<std::size_t>(y * width + x);
                    const double a = first[at], b = second[at];
                    pixels.emplace_back(0.5 * (a + b), 0.25 * (a - b) * (a - b));
                    mean += 0.5 * (a + b);
                }
            }
            mean /= static_cast<double>(pixels.size());
            for (const auto& [own, square] : pixels)
            {
                squares.push_back(square / (mean * mean + 0.01));
                sum += squares.back();
                typical += square / (std::pow(std::max(own, mean), 2) + 0.01);
            }
            tiles.push_back(typical / static_cast<double>(pixels.size()));
        }
    }
    std::sort(squares.begin(), squares.end(), std::greater<double>());
    std::sort(tiles.begin(), tiles.end());
    const std::size_t worst = std::max<std::size_t>(1, squares.size() / 1000);
    double worstSum = 0.0;
    for (std::size_t k = 0; k < worst; ++k)
        worstSum += squares[k];
    return {std::sqrt(sum / static_cast<double>(squares.size())),
            std::sqrt(tiles[tiles.size() / 2]), worstSum / sum};
}

} // namespace

TEST_CASE("error estimate: a few bright pixels make the mean square, but not the median tile",
          "[film]")
{
    // Each pixel is 1.9 in one half and 2.1 in the other: an error of 0.1 over sqrt(4 + 0.01). Of
    // 64 x 64 pixels the worst thousandth are the four that only one half has met: 100 +- 100.
    const auto isSpot = [](int x, int y) { return y == 5 && x % 16 == 3; };
    const Film plain =
        filmOf(64, 64, [](int pass, int x, int) { return (pass + x) % 2 == 0 ? 1.9f : 2.1f; });
    const Film spots = filmOf(64, 64,
                              [&](int pass, int x, int y)
                              {
                                  if (isSpot(x, y)) return pass == 0 ? 200.0f : 0.0f;
                                  return (pass + x) % 2 == 0 ? 1.9f : 2.1f;
                              });
    const double error = 0.1 / std::sqrt(4.01);
    const ErrorEstimate even = estimateError(plain, Workers(1));
    CHECK(even.relative == Approx(error).epsilon(1e-5));
    CHECK(even.median == Approx(error).epsilon(1e-5));
    CHECK(even.worstShare == Approx(4.0 / 4096.0).epsilon(1e-5));

    const double mean = 2.0 + 98.0 / 256.0; // of a tile with a spot
    const double spot2 = 1e4 / (mean * mean + 0.01);
    const double rest2 = 4092.0 * 0.01 / 4.01; // to 1 %: the tiles with spots are brighter
    const ErrorEstimate few = estimateError(spots, Workers(2));
    CHECK(few.relative == Approx(std::sqrt((4.0 * spot2 + rest2) / 4096.0)).epsilon(1e-3));
    CHECK(few.median == Approx(error).epsilon(1e-5));
    CHECK(few.worstShare == Approx(4.0 * spot2 / (4.0 * spot2 + rest2)).epsilon(1e-3));
}

TEST_CASE("error estimate: the median tile is one of those that show something", "[film]")
{
    // Twelve of sixteen tiles are black.
    const Film film = filmOf(64, 64,
                             [](int pass, int, int y) {
                                 return y >= 16 ? 0.0f : pass == 0 ? 1.9f : 2.1f;
                             });
    CHECK(estimateError(film, Workers(1)).median == Approx(0.1 / std::sqrt(4.01)).epsilon(1e-5));
}

TEST_CASE("error estimate: the same as pixel by pixel, for any size and number of threads",
          "[film]")
{
    for (const auto& [width, height] :
         {std::pair(1, 1), std::pair(100, 70), std::pair(33, 129), std::pair(640, 400)})
    {
        // Heavy tails: some tiles hold many of the worst pixels, most hold none.
        Uniform random(static_cast<uint32_t>(width));
        std::vector<float> halves[2];
        for (std::vector<float>& half : halves)
            for (int k = 0; k < width * height; ++k)
                half.push_back(0.5f / std::max(1e-4f, static_cast<float>(random())));
        const Film film = filmOf(
            width, height,
            [&, w = width, h = height](int pass, int x, int y)
            { return x < w && y < h ? halves[pass][static_cast<std::size_t>(y * w + x)] : 7.0f; });
        const ErrorEstimate expected = plainEstimate(width, height, halves[0], halves[1]);
        const ErrorEstimate one = estimateError(film, Workers(1)),
                            three = estimateError(film, Workers(3));
        CAPTURE(width, height);
        CHECK(one.relative == Approx(expected.relative).epsilon(1e-5));
        CHECK(one.median == Approx(expected.median).epsilon(1e-5));
        CHECK(one.worstShare == Approx(expected.worstShare).epsilon(1e-5));
        CHECK(one.relative == three.relative);
        CHECK(one.median == three.median);
        CHECK(one.worstShare == three.worstShare);
    }
}

TEST_CASE("error estimate: infinite below two passes", "[film]")
{
    Film film;
    film.reset(20, 20);
    CHECK(std::isinf(estimateError(film, Workers(1)).relative));
    CHECK(std::isinf(estimateError(film, Workers(1)).median));
}
