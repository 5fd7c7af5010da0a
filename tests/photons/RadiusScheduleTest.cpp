// RadiusScheduleTest.cpp - bias and variance of progressive density estimates are those of theory.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/photons/RadiusSchedule.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

// The density is 1 + 8 (x^2 + y^2) on the square [-1,1]^2, and it is looked up at the centre.
constexpr double kMass = 4.0 + 64.0 / 3.0;
constexpr double kCentre = 1.0 / kMass;
constexpr double kLaplacian = 32.0 / kMass;
constexpr double kRadius = 0.25;
constexpr int kPhotons = 2000; ///< a pass
constexpr int kRuns = 16000;

/// Returns the share of the photons that fall into the disc.
double insideDisc(double radius2)
{
    return kPi * radius2 * (1.0 + 4.0 * radius2) / kMass;
}

double gammaRatio(double a, double b)
{
    return std::exp(std::lgamma(a) - std::lgamma(b));
}

/// Returns the bias of the mean of n passes of the global schedule with a flat disc. It is exact
/// for a density of constant Laplacian, and follows from the recurrence.
double theoryBias(int n, double alpha)
{
    const double grown = gammaRatio(n + 1 + alpha, n + 1.0) / std::tgamma(1.0 + alpha);
    return kRadius * kRadius * kLaplacian / 8.0 / (n * alpha) * (grown - 1.0);
}

/// Returns the variance of the mean of n passes for a density that is constant at its value in the
/// centre.
double theoryVariance(int n, double alpha)
{
    const double sum = gammaRatio(n + 2.0, n + alpha) - 1.0 / std::tgamma(alpha);
    return kCentre / (kPhotons * double(kPi) * kRadius * kRadius) * std::tgamma(1.0 + alpha) /
           ((2.0 - alpha) * n * n) * sum;
}

/// Draws counts of a binomial distribution by inversion.
class Binomial
{
public:
    Binomial(int trials, double p)
    {
        double term = std::pow(1.0 - p, trials), sum = 0.0;
        for (int k = 0; k < trials && sum < 1.0 - 1e-12; ++k)
        {
            _cumulative.push_back(sum += term);
            term *= (trials - k) / (k + 1.0) * p / (1.0 - p);
        }
    }
    int operator()(std::mt19937& engine) const
    {
        const double u = (double(engine()) + 0.5) * 0x1p-32;
        return static_cast<int>(std::upper_bound(_cumulative.begin(), _cumulative.end() - 1, u) -
                                _cumulative.begin());
    }

private:
    std::vector<double> _cumulative;
};

} // namespace

TEST_CASE("radius schedule: the global radii follow their recurrence", "[photons]")
{
    for (const double alpha : {0.5, 2.0 / 3.0, 0.8})
    {
        CHECK(globalRadiusSquared(0, alpha) == Approx(1.0).epsilon(1e-12));
        double expected = 1.0;
        for (int i = 1; i < 2000; ++i)
        {
            expected *= (i + alpha) / (i + 1.0);
            REQUIRE(globalRadiusSquared(i, alpha) == Approx(expected).epsilon(1e-10));
        }
    }
    for (const int delay : {0, 1, 32}) // as many passes later in the same recurrence
    {
        double expected = 1.0;
        for (int i = 1; i < 2000; ++i)
        {
            expected *= (i + delay + 0.8) / (i + delay + 1.0);
            REQUIRE(globalRadiusSquared(i, 0.8, delay) == Approx(expected).epsilon(1e-10));
        }
    }
    // The radii of passes 100, 10^4 and 10^6 over the first are the published ones.
    CHECK(std::sqrt(globalRadiusSquared(99, 2.0 / 3.0)) == Approx(0.488).epsilon(2e-3));
    CHECK(std::sqrt(globalRadiusSquared(9999, 2.0 / 3.0)) == Approx(0.227).epsilon(3e-3));
    CHECK(std::sqrt(globalRadiusSquared(999999, 2.0 / 3.0)) == Approx(0.105).epsilon(5e-3));
}

// The standard error of the mean is 0.4 % of the bias, that of the variance 1.1 %: a false alarm of
// the tightest bound, at 4.5 standard errors, has a probability below 1e-4.
TEST_CASE("radius schedule: bias and variance of the global schedule on a curved density",
          "[photons][statistics][long]")
{
    for (const double alpha : {0.5, 2.0 / 3.0, 0.8})
    {
        std::mt19937 engine(17);
        std::vector<double> sums(kRuns);
        for (int pass = 0; pass < 4096; ++pass)
        {
            const double radius2 = kRadius * kRadius * globalRadiusSquared(pass, alpha);
            const Binomial counts(kPhotons, insideDisc(radius2));
            const double scale = 1.0 / (kPhotons * double(kPi) * radius2);
            for (double& sum : sums)
                sum += counts(engine) * scale;
            const int n = pass + 1;
            if (n != 256 && n != 1024 && n != 4096) continue;
            Estimate estimate;
            for (const double sum : sums)
                estimate.add(sum / n);
            CAPTURE(alpha, n, estimate.mean() - kCentre, theoryBias(n, alpha), estimate.variance(),
                    theoryVariance(n, alpha));
            CHECK(estimate.mean() - kCentre == Approx(theoryBias(n, alpha)).epsilon(0.03));
            const double bound = n == 4096 && alpha <= 0.7 ? 0.05 : 0.12;
            CHECK(estimate.variance() == Approx(theoryVariance(n, alpha)).epsilon(bound));
        }
    }
}

TEST_CASE("radius schedule: a pixel's own statistics", "[photons]")
{
    LocalStatistics s;
    s.radius2 = 4.0f;
    addPhotons(s, 10, Vec3(5.0f), 0.5f); // N = 5; R^2 and the flux are halved
    CHECK(s.photons == 5.0f);
    CHECK(s.radius2 == 2.0f);
    CHECK(s.flux == Vec3(2.5f));
    addPhotons(s, 0, Vec3(0.0f), 0.5f); // an empty pass counts, and changes nothing else
    CHECK(s.radius2 == 2.0f);
    addPhotons(s, 15, Vec3(3.0f), 0.5f); // N = 12.5 of 20
    CHECK(s.photons == 12.5f);
    CHECK(s.radius2 == Approx(2.0f * 12.5f / 20.0f));
    CHECK(s.flux.y == Approx(5.5f * 12.5f / 20.0f));
    CHECK(localRadiance(s).z == Approx(5.5f / (kPi * 2.0f * 3.0f)));
    CHECK(localRadiance(LocalStatistics()) == Vec3(0.0f));
}

TEST_CASE("radius schedule: the local schedule converges to an even density",
          "[photons][statistics]")
{
    // Each pass has 2000 photons, even on a unit square; the disc holds 39 of them at first.
    Estimate estimate;
    float radius2 = 0.0f;
    for (uint32_t run = 0; run < 400; ++run)
    {
        std::mt19937 engine(run);
        LocalStatistics s;
        s.radius2 = 0.00625f;
        for (int pass = 0; pass < 256; ++pass)
        {
            const Binomial counts(kPhotons, double(kPi) * double(s.radius2));
            const int count = counts(engine);
            addPhotons(s, static_cast<uint32_t>(count), Vec3(static_cast<float>(count)),
                       2.0f / 3.0f);
        }
        estimate.add(double(localRadiance(s).x) / kPhotons);
        radius2 = s.radius2;
    }
    CAPTURE(estimate.mean(), estimate.standardError());
    // The radii depend on the counts, but a bias by this is not visible at a standard error of 0.13
    // %.
    CHECK(std::abs(estimate.mean() - 1.0) <= 4.0 * estimate.standardError());
    CHECK(radius2 < 0.3f * 0.00625f);
}
