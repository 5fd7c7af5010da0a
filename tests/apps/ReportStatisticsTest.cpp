// ReportStatisticsTest.cpp - the report's slopes, errors and distributions compared with known
// answers.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "apps/osgraytracebench/report/BudgetSums.h"
#include "apps/osgraytracebench/report/ScheduleStudy.h"
#include "apps/osgraytracebench/report/Slopes.h"

#include <cmath>

using namespace osgRayTrace::bench;
using osgRayTrace::engine::test::Estimate;
using osgRayTrace::engine::test::Uniform;

namespace
{

double normal(Uniform& random)
{
    double sum = -6.0;
    for (int i = 0; i < 12; ++i)
        sum += random();
    return sum;
}

Reference flatReference(double value, double variance)
{
    Reference reference;
    reference.width = 40;
    reference.height = 30;
    reference.mean.assign(3 * 1200, value);
    reference.variance.assign(3 * 1200, variance);
    finish(reference);
    return reference;
}

/// Returns pictures of the value with normal noise, which is the same in all colours of a pixel.
Pixels noisyPicture(double value, double deviation, Uniform& random)
{
    Pixels pixels{40, 30, {}};
    for (int p = 0; p < 1200; ++p)
    {
        const float x = static_cast<float>(value + deviation * normal(random));
        pixels.rgb.insert(pixels.rgb.end(), {x, x, x});
    }
    return pixels;
}

} // namespace

TEST_CASE("slopes: power laws are found, with their error", "[report]")
{
    std::vector<Series> exact(3);
    for (Series& series : exact)
        for (const double x : {1.0, 2.0, 4.0, 8.0})
        {
            series.x.push_back(x);
            series.y.push_back(7.0 * std::pow(x, -1.5));
        }
    const std::optional<Slope> slope = logLogSlope(exact);
    REQUIRE(slope);
    CHECK(slope->value == Approx(-1.5));
    CHECK(slope->error == Approx(0.0).margin(1e-12));
    CHECK_FALSE(logLogSlope({Series{{1.0}, {1.0}}}));

    // The test makes 400 fits to noisy series: their scatter must be the error that each fit
    // states.
    Uniform random(1);
    Estimate slopes, errors;
    for (int run = 0; run < 400; ++run)
    {
        std::vector<Series> noisy = exact;
        for (Series& series : noisy)
            for (double& y : series.y)
                y *= 1.0 + 0.05 * normal(random);
        const std::optional<Slope> found = logLogSlope(noisy);
        slopes.add(found->value);
        errors.add(found->error * found->error);
    }
    CHECK(slopes.agrees(-1.5));
    CHECK(std::sqrt(errors.mean() / slopes.variance()) ==
          Approx(1.0).margin(0.25)); // 4 standard errors
}

TEST_CASE("slopes: the time to a target lies on the line between its neighbours", "[report]")
{
    const std::vector<double> x{1.0, 2.0, 4.0}, y{1.0, 0.25, 0.0625};
    CHECK(crossing(x, y, 0.11111111).value() == Approx(3.0).epsilon(1e-6));
    CHECK_FALSE(crossing(x, y, 0.01));
    CHECK_FALSE(crossing(x, y, 2.0));
}

TEST_CASE("statistics: Student's distribution at the quantiles of tables", "[report]")
{
    CHECK(studentTail(12.706, 1) == Approx(0.05).epsilon(1e-3));
    CHECK(studentTail(4.303, 2) == Approx(0.05).epsilon(1e-3));
    CHECK(studentTail(2.947, 15) == Approx(0.01).epsilon(2e-3));
    CHECK(studentTail(2.576, 1e6) == Approx(0.01).epsilon(2e-3));
    CHECK(studentTail(0.0, 5) == Approx(1.0));
    CHECK(1.0 - std::pow(1.0 - sidak(0.01, 1000), 1000) == Approx(0.01));
}

TEST_CASE("budget sums: errors, variance and bias of pictures with known noise", "[report]")
{
    const Reference reference = flatReference(2.0, 0.0);
    Uniform random(2);
    BudgetSums sums(reference);
    for (int seed = 0; seed < 16; ++seed)
        sums.add(noisyPicture(2.02, 0.3, random), {0.5, 4.0, 100.0, 0, seed == 0});
    const ReportRow row = sums.row();
    const double mse = 0.09 + 0.0004; // 19200 values: 1 % standard error
    CHECK(row.seeds == 16);
    CHECK(row.mse == Approx(mse).epsilon(0.05));
    CHECK(row.relMse == Approx(mse / (4.0 + 0.0004)).epsilon(0.05));
    CHECK(row.relMseFixed == Approx(mse / 4.01).epsilon(0.05));
    CHECK(row.mseError ==
          Approx(mse * std::sqrt(2.0 / 19200)).epsilon(0.6)); // estimated from 16 values
    CHECK(row.efficiency == Approx(1.0 / (0.09 * 0.5)).epsilon(0.05));
    // The standard error 0.3 / sqrt(19200) is 0.108 % of 2.
    CHECK(row.biasError == Approx(0.108).epsilon(0.05));
    CHECK(std::abs(row.biasPercent - 1.0) < 4.0 * 0.108);
    CHECK(row.percentile999 == Approx(0.3 * 3.29).epsilon(0.15));
    CHECK(row.flip > 0.0);
    CHECK(row.nonFinite == 0);
}

TEST_CASE("budget sums: the reference's own noise is taken off", "[report]")
{
    // The reference is a noisy picture itself, of known variance.
    Uniform random(3);
    Reference reference = flatReference(2.0, 0.04);
    for (std::size_t i = 0; i < reference.mean.size(); i += 3)
    {
        const double noise = 0.2 * normal(random);
        for (std::size_t c = 0; c < 3; ++c)
            reference.mean[i + c] += noise;
    }
    BudgetSums sums(reference);
    for (int seed = 0; seed < 16; ++seed)
        sums.add(noisyPicture(2.0, 0.3, random), {});
    CHECK(sums.row().mse == Approx(0.09).epsilon(0.1));
    CHECK(std::abs(sums.row().biasPercent) < 4.0 * sums.row().biasError);
    CHECK(sums.row().biasError ==
          Approx(100.0 * std::sqrt((0.09 / 16 + 0.04) / 1200) / 2.0).epsilon(0.1));
}

TEST_CASE("budget sums: what is not finite is counted, not averaged", "[report]")
{
    const Reference reference = flatReference(1.0, 0.0);
    Uniform random(4);
    Pixels pixels = noisyPicture(1.0, 0.1, random);
    pixels.rgb[5] = std::nanf("");
    pixels.rgb[77] = INFINITY;
    BudgetSums sums(reference);
    sums.add(pixels, {1.0, 1.0, 1.0, 3, false});
    CHECK(sums.row().nonFinite == 5);
    CHECK(std::isfinite(sums.row().relMse));
}

TEST_CASE("schedules: the sums over passes are those of the recurrence", "[report]")
{
    for (const double alpha : {0.5, 2.0 / 3.0, 0.8})
    {
        double radius2 = 1.0, sum = 0.0, inverse = 0.0;
        for (int n = 1; n <= 4096; ++n)
        {
            sum += radius2;
            inverse += 1.0 / radius2;
            radius2 *= (n + alpha) / (n + 1.0); // [Knaus11]
            if ((n & (n - 1)) != 0) continue;
            CHECK(meanSquaredRadius(n, alpha) == Approx(sum / n).epsilon(1e-9));
            CHECK(meanInverseSquaredRadius(n, alpha) ==
                  Approx(inverse / (double(n) * n)).epsilon(1e-9));
        }
    }
}
