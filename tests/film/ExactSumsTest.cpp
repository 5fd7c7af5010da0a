// ExactSumsTest.cpp - sums that are the same in whatever order and parts they are made.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/film/PassSums.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

using namespace osgRayTrace::engine;

namespace
{

struct Pass
{
    TileRgba values;
};

/// Returns the values of a tile one after the other, as ExactSums numbers them.
float* floatsOf(TileRgba& values)
{
    return reinterpret_cast<float*>(&values);
}

/// Returns passes of a tile whose values are spread over many powers of two, up to the largest.
std::vector<Pass> passesOf(int count, double largestExponent)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> exponent(-30.0, largestExponent), sign(-0.2, 1.0);
    std::vector<Pass> passes(static_cast<std::size_t>(count));
    for (Pass& pass : passes)
    {
        float* values = floatsOf(pass.values);
        for (std::size_t i = 0; i < ExactSums::kValues; ++i)
            values[i] =
                static_cast<float>(std::copysign(std::exp2(exponent(random)), sign(random)));
    }
    return passes;
}

/// Returns a film of one tile that is not whole, with these passes.
std::unique_ptr<Film> filmOf(const std::vector<Pass>& passes, const std::vector<int>& numbers)
{
    auto film = std::make_unique<Film>();
    film->reset(13, 9, FilmSums::Exact);
    std::fill_n(film->depth(0), kTilePixels, 0.5f);
    for (const int number : numbers)
    {
        film->beginPass();
        CHECK(film->addPass(0, number, passes[static_cast<std::size_t>(number)].values) == 0);
    }
    return film;
}

PassSet setOf(const std::vector<int>& numbers)
{
    PassSet set;
    for (const int number : numbers)
        set.add(number);
    return set;
}

bool areEqual(const PassSums& a, const PassSums& b)
{
    return a.passes == b.passes && a.low == b.low && a.high == b.high && a.depth == b.depth;
}

} // namespace

TEST_CASE("exact sums: any order and any parts give the same bits", "[film]")
{
    // Values up to 2^35 take high parts; those up to 2^10 do not.
    for (const double exponent : {10.0, 35.0})
    {
        CAPTURE(exponent);
        constexpr int kPasses = 50;
        const std::vector<Pass> passes = passesOf(kPasses, exponent);
        std::vector<int> order(kPasses);
        for (int i = 0; i < kPasses; ++i)
            order[static_cast<std::size_t>(i)] = i;
        const PassSums whole = sumsOf(*filmOf(passes, order), PassSet(kPasses));
        CHECK(whole.high.empty() == (exponent < 11.0));

        std::mt19937 random(3);
        for (int round = 0; round < 10; ++round)
        {
            std::shuffle(order.begin(), order.end(), random);
            const auto cut = order.begin() + static_cast<std::ptrdiff_t>(1 + random() % 48);
            const std::vector<int> first(order.begin(), cut), second(cut, order.end());
            PassSums sums = sumsOf(*filmOf(passes, first), setOf(first));
            addSums(sumsOf(*filmOf(passes, second), setOf(second)), sums);
            CHECK(areEqual(sums, whole));
        }
    }
}

TEST_CASE("exact sums: means are those of sums in double", "[film]")
{
    constexpr int kPasses = 200;
    std::vector<Pass> passes = passesOf(kPasses, 8.0);
    std::vector<int> numbers;
    for (int i = 0; i < kPasses; ++i)
        numbers.push_back(i);
    TileRgba mean, even, odd;
    const auto film = filmOf(passes, numbers);
    film->mean(0, mean);
    film->halfMeans(0, even, odd);
    for (std::size_t i = 0; i < ExactSums::kValues; ++i)
    {
        double sums[2] = {0.0, 0.0}, magnitude = 0.0;
        for (int pass = 0; pass < kPasses; ++pass)
        {
            const double value = double(floatsOf(passes[static_cast<std::size_t>(pass)].values)[i]);
            sums[pass % 2] += value;
            magnitude += std::fabs(value);
        }
        const double tolerance = 1e-6 * magnitude / kPasses;
        REQUIRE(std::fabs(floatsOf(mean)[i] - (sums[0] + sums[1]) / kPasses) <= tolerance);
        REQUIRE(std::fabs(floatsOf(even)[i] - sums[0] / (kPasses / 2)) <= 2.0 * tolerance);
        REQUIRE(std::fabs(floatsOf(odd)[i] - sums[1] / (kPasses / 2)) <= 2.0 * tolerance);
    }
}

TEST_CASE("exact sums: so many passes that low parts are carried over", "[film]")
{
    constexpr int kPasses = 5000; // of each half; low parts of 2^51 would overflow after 4096
    const float bright = std::nextafter(2048.0f, 0.0f);
    auto values = std::make_unique<Pass>();
    std::fill_n(floatsOf(values->values), ExactSums::kValues, bright);
    Film film;
    film.reset(16, 16, FilmSums::Exact);
    for (int pass = 0; pass < 2 * kPasses; ++pass)
        REQUIRE(film.addPass(0, pass, values->values) == 0);
    TileRgba mean;
    film.mean(0, mean);
    CHECK(mean[3].g[7] == bright);
    const ExactSum sum = film.exactSums().sum(0, 1, 17);
    CHECK(double(sum.low) * 0x1p-40 + double(sum.high) * 0x1p-12 == double(bright) * kPasses);
}

TEST_CASE("exact sums: what has no place is left out and counted", "[film]")
{
    Film film;
    film.reset(16, 16, FilmSums::Exact);
    auto pass = std::make_unique<Pass>();
    std::fill_n(floatsOf(pass->values), ExactSums::kValues, 1.0f);
    pass->values[2].g[3] = std::numeric_limits<float>::quiet_NaN();
    pass->values[2].g[4] = std::numeric_limits<float>::infinity();
    pass->values[2].g[5] = 0x1p40f;
    pass->values[2].g[6] = std::nextafter(0x1p40f, 0.0f);
    CHECK(film.addPass(0, 0, pass->values) == 3);
    TileRgba mean;
    film.mean(0, mean);
    CHECK(mean[2].g[3] == 0.0f);
    CHECK(mean[2].g[5] == 0.0f);
    CHECK(mean[2].g[6] == std::nextafter(0x1p40f, 0.0f));
    CHECK(mean[2].r[3] == 1.0f);
}

TEST_CASE("exact sums: a film is the same after its sums have been elsewhere", "[film]")
{
    const std::vector<Pass> passes = passesOf(7, 35.0);
    const auto film = filmOf(passes, {0, 1, 2, 5});
    PassSums sums = sumsOf(*film, setOf({0, 1, 2, 5}));
    Film back;
    setFilm(sums, back);
    CHECK(back.halfPasses(0, 0) == 2);
    CHECK(back.halfPasses(0, 1) == 2);
    CHECK(back.depth(0)[0] == 0.5f);
    back.addPass(0, 6, passes[6].values);
    film->addPass(0, 6, passes[6].values);
    sums.passes.add(6);
    CHECK(areEqual(sumsOf(back, sums.passes), sumsOf(*film, sums.passes)));
}

TEST_CASE("exact sums: the depth is that of the least pass", "[film]")
{
    const std::vector<Pass> passes = passesOf(4, 1.0);
    PassSums early = sumsOf(*filmOf(passes, {1}), setOf({1}));
    PassSums late = sumsOf(*filmOf(passes, {3}), setOf({3}));
    std::fill(late.depth.begin(), late.depth.end(), 0.25f);
    addSums(early, late);
    CHECK(late.depth == early.depth);
}

TEST_CASE("film: the error of halves of different sizes is that of their mean",
          "[film][statistics]")
{
    // 1024 means of 6 even passes and 2 odd ones, each value of variance 1: the mean of 8 has 1/8.
    // The mean square of n estimates is within 4 sqrt(2 / n) of it but once in 15,000 times.
    std::mt19937 random(11);
    std::normal_distribution<float> normal;
    Film film;
    film.reset(16, 16, FilmSums::Exact);
    for (const int pass : {0, 2, 4, 6, 8, 10, 1, 3})
    {
        auto values = std::make_unique<Pass>();
        for (std::size_t i = 0; i < ExactSums::kValues; ++i)
            floatsOf(values->values)[i] = normal(random);
        film.addPass(0, pass, values->values);
    }
    TileRgba even, odd;
    film.halfMeans(0, even, odd);
    double squares = 0.0;
    for (std::size_t i = 0; i < ExactSums::kValues; ++i)
    {
        const double error =
            double(film.errorScale(0)) * double(floatsOf(even)[i] - floatsOf(odd)[i]);
        squares += error * error;
    }
    const auto n = double(ExactSums::kValues);
    CHECK(std::fabs(squares / n * 8.0 - 1.0) < 4.0 * std::sqrt(2.0 / n));
}

TEST_CASE("exact sums: a film that begins anew forgets what was bright before", "[film]")
{
    std::vector<Pass> passes(1);
    const auto fill = [&passes](float value)
    { std::fill_n(floatsOf(passes[0].values), ExactSums::kValues, value); };
    fill(4096.0f);
    const auto film = filmOf(passes, {0});
    film->reset(13, 9, FilmSums::Exact);
    fill(1.0f);
    film->addPass(0, 0, passes[0].values);
    TileRgba mean;
    film->mean(0, mean);
    CHECK(floatsOf(mean)[5] == 1.0f);
    CHECK(film->exactSums().sum(0, 0, 5) == ExactSum{int64_t(1) << 40, 0});
}
