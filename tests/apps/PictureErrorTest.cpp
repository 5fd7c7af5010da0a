// PictureErrorTest.cpp - the figures of the benchmark of transport compared with known answers.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "apps/osgraytracebench/report/PictureError.h"

#include <cmath>

using namespace osgRayTrace::bench;
using osgRayTrace::engine::test::Uniform;

namespace
{

constexpr int kWidth = 50, kHeight = 40, kPixels = kWidth * kHeight;

double normal(Uniform& random)
{
    double sum = -6.0;
    for (int i = 0; i < 12; ++i)
        sum += random();
    return sum;
}

} // namespace

TEST_CASE("picture error: the worst thousandth is left out, and the reference's noise", "[report]")
{
    Reference reference;
    reference.width = kWidth;
    reference.height = kHeight;
    reference.mean.assign(3 * kPixels, 2.0);
    reference.variance.assign(3 * kPixels, 0.01);
    finish(reference);
    Pixels pixels{kWidth, kHeight, std::vector<float>(3 * kPixels, 2.5f)};
    for (const std::size_t pixel : {17u, 1234u})
        pixels.rgb[3 * pixel + 1] = 102.0f;
    const double square = 4.0 + std::pow(0.01 * 2.0, 2.0), plain = (0.25 - 0.01) / square;
    const PictureError error = pictureError(pixels, reference);
    CHECK(error.trimmed == Approx(plain).epsilon(1e-6));
    CHECK(error.relMse ==
          Approx(plain + 2.0 * (100.0 * 100.0 - 0.25) / square / (3.0 * kPixels)).epsilon(1e-6));
}

TEST_CASE("seed medians: of an odd and an even number of pictures", "[report]")
{
    CHECK(medianOfSeeds({3.0, 1.0, 5.0}).value == 3.0);
    CHECK(medianOfSeeds({3.0, 1.0, 5.0, 4.0}).value == 3.5);
    CHECK(medianOfSeeds({3.0, 1.0, 5.0, 4.0}).spread == 5.0);
    CHECK(medianOfSeeds({2.0, 2.0, 2.0}).agreement == 1.0);
    CHECK(medianOfSeeds({-1.0, 2.0, 4.0}).value == 2.0);
    CHECK(medianOfSeeds({-1.0, 2.0, 4.0}).spread == 2.0);
    CHECK(medianOfSeeds({-1.0, 0.0}).value == 0.0);
}

// 4,000 pairs of runs with five pictures each, whose errors have a logarithm with a deviation of
// 0.4. Pairs that agree are 95 of 100 if the factor is right; their share has a standard error of
// 0.35 of 100. The median of five is a little more precise than the formula for many: 0.94 to 0.98
// is four standard errors and this.
TEST_CASE("seed medians: two runs agree within the factor that they state", "[report][statistics]")
{
    Uniform random(3);
    const auto run = [&]
    {
        std::vector<double> values;
        for (int picture = 0; picture < 5; ++picture)
            values.push_back(std::exp(0.4 * normal(random)));
        return medianOfSeeds(values);
    };
    int agree = 0;
    for (int pair = 0; pair < 4000; ++pair)
    {
        const SeedMedian first = run(), second = run();
        agree += std::abs(std::log(first.value / second.value)) < std::log(first.agreement);
    }
    CHECK(agree / 4000.0 > 0.94);
    CHECK(agree / 4000.0 < 0.98);
}
