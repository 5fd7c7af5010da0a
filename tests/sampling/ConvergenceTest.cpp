// ConvergenceTest.cpp - how the variance of a light's irradiance falls with the number of samples.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/sampling/LightPoints.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

enum class Strategy
{
    Random,
    UniformJitter,
    Stratified,
    Sobol,
};

enum class Occluder
{
    None,
    AxisEdge,
    RotatedEdge,
};

/// Returns cos cos / r^2 of a point (u, v) of a unit square light at height 1 over a receiver at
/// (x, 0, 0).
double kernel(double u, double v, double x, Occluder occluder)
{
    const double dx = u - 0.5 - x, dy = v - 0.5;
    const double d2 = dx * dx + dy * dy + 1.0;
    if (occluder == Occluder::AxisEdge && u > 0.37 + 0.2 * x) return 0.0;
    const double turn = 17.0 * M_PI / 180.0;
    if (occluder == Occluder::RotatedEdge && std::cos(turn) * dx + std::sin(turn) * dy > 0.11)
        return 0.0;
    return 1.0 / (d2 * d2);
}

/// Returns the variance of the mean of n*n samples, over receivers and seeds.
double variance(Strategy strategy, Occluder occluder, uint32_t n)
{
    constexpr int kReceivers = 30, kSeeds = 100;
    double sum = 0.0;
    for (int r = 0; r < kReceivers; ++r)
    {
        const double x = 1.2 * r / kReceivers;
        Estimate estimate;
        for (uint32_t s = 0; s < kSeeds; ++s)
        {
            const uint32_t seed = hash(s, static_cast<uint32_t>(r));
            double mean = 0.0;
            for (uint32_t j = 0; j < n * n; ++j)
            {
                float u = 0.0f, v = 0.0f;
                switch (strategy)
                {
                case Strategy::Random:
                    random2(j, seed, u, v);
                    break;
                case Strategy::UniformJitter:
                    uniformJitter2(j, n, 0, seed, u, v);
                    break;
                case Strategy::Stratified:
                    stratified2(j, n, 0, seed, u, v);
                    break;
                case Strategy::Sobol:
                    sobol2(j, seed, u, v);
                    break;
                }
                mean += kernel(u, v, x, occluder);
            }
            estimate.add(mean / (n * n));
        }
        sum += estimate.variance();
    }
    return sum / kReceivers;
}

struct Convergence
{
    double slope;
    double last; ///< variance at 1024 samples
};

Convergence convergence(Strategy strategy, Occluder occluder)
{
    std::vector<double> samples, variances;
    for (const uint32_t n : {8u, 16u, 32u})
    {
        samples.push_back(n * n);
        variances.push_back(variance(strategy, occluder, n));
    }
    return {logLogSlope(samples, variances), variances.back()};
}

} // namespace

// Each slope is fitted to 3 numbers of samples with 3000 runs each: its standard error is about
// 0.03, so the margins below are 4 standard errors.

TEST_CASE("convergence: unoccluded square light", "[sampling][statistics]")
{
    const Convergence random = convergence(Strategy::Random, Occluder::None);
    const Convergence uniform = convergence(Strategy::UniformJitter, Occluder::None);
    const Convergence stratified = convergence(Strategy::Stratified, Occluder::None);
    const Convergence sobol = convergence(Strategy::Sobol, Occluder::None);
    CHECK(random.slope == Approx(-1.0).margin(0.12));
    CHECK(uniform.slope == Approx(-1.0).margin(0.12));
    CHECK(stratified.slope == Approx(-2.0).margin(0.12));
    CHECK(sobol.slope < -2.5);
    CHECK(uniform.last < random.last);
    CHECK(stratified.last < 0.01 * uniform.last);
    CHECK(sobol.last < 0.1 * stratified.last);
}

TEST_CASE("convergence: square light behind an axis-aligned edge", "[sampling][statistics]")
{
    const Convergence random = convergence(Strategy::Random, Occluder::AxisEdge);
    const Convergence uniform = convergence(Strategy::UniformJitter, Occluder::AxisEdge);
    const Convergence stratified = convergence(Strategy::Stratified, Occluder::AxisEdge);
    const Convergence sobol = convergence(Strategy::Sobol, Occluder::AxisEdge);
    CHECK(random.slope == Approx(-1.0).margin(0.12));
    CHECK(uniform.slope == Approx(-1.0).margin(0.15));
    CHECK(stratified.slope == Approx(-1.5).margin(0.15));
    CHECK(sobol.slope < -1.75);
    CHECK(sobol.last < stratified.last);
    CHECK(stratified.last < uniform.last);
    CHECK(uniform.last < random.last);
}

TEST_CASE("convergence: square light behind a rotated edge", "[sampling][statistics]")
{
    const Convergence stratified = convergence(Strategy::Stratified, Occluder::RotatedEdge);
    const Convergence sobol = convergence(Strategy::Sobol, Occluder::RotatedEdge);
    CHECK(stratified.slope == Approx(-1.5).margin(0.15));
    CHECK(sobol.slope < -1.38); // -1.5, and 4 standard errors
    CHECK(sobol.last < stratified.last);
}
