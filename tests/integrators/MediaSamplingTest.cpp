// MediaSamplingTest.cpp - samples of phase functions, free flights and points along rays.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/Equiangular.h"
#include "osgRayTrace/media/FreeFlight.h"
#include "osgRayTrace/media/MediumStack.h"
#include "osgRayTrace/media/PhaseFunction.h"
#include "osgRayTrace/media/Transmittance.h"

#include "tests/Catch.h"
#include "tests/Statistics.h"

#include <functional>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr double kSignificance = 1e-3; ///< false alarms of all chi-square tests of a case together
constexpr int kSamples = 40000, kCells = 64;

/// Returns the integral of a density over each of the cells of [low, high].
std::vector<double> expectedCounts(const std::function<double(double)>& density, double low,
                                   double high)
{
    std::vector<double> counts;
    for (int cell = 0; cell < kCells; ++cell)
    {
        double sum = 0.0;
        for (int k = 0; k < 64; ++k)
            sum += density(low + (high - low) * (cell + (k + 0.5) / 64.0) / kCells);
        counts.push_back(kSamples * sum / 64.0 * (high - low) / kCells);
    }
    return counts;
}

void count(std::vector<double>& counts, double value, double low, double high)
{
    const int cell = static_cast<int>((value - low) / (high - low) * kCells);
    if (cell >= 0 && cell < kCells) counts[static_cast<std::size_t>(cell)] += 1.0;
}

} // namespace

TEST_CASE("phase: samples have the density that is evaluated, and the mean cosine g",
          "[integrators][statistics][media]")
{
    Uniform random(1);
    const float anisotropies[] = {0.0f, 0.3f, -0.6f, 0.9f, 0.999f, -0.999f};
    for (const float g : anisotropies)
    {
        std::vector<double> counts(kCells);
        Estimate cosine, second;
        const Vec3 axis = glm::normalize(Vec3(0.3f, -0.5f, 0.8f));
        for (int i = 0; i < kSamples; ++i)
        {
            const float u = random(), v = random();
            const Vec3 w = samplePhase(g, axis, u, v);
            CHECK(glm::length(w) == Approx(1.0).margin(1e-5));
            const double z = double(glm::dot(w, axis));
            cosine.add(z);
            second.add(0.5 * (3.0 * z * z - 1.0));
            count(counts, z, -1.0, 1.0);
        }
        const auto expected = expectedCounts(
            [g](double z) { return 6.283185307 * double(evalPhase(g, float(z))); }, -1.0, 1.0);
        CAPTURE(g);
        if (std::fabs(g) < 0.95f) // the peaks of others are narrower than cells
            CHECK(chiSquareTest(counts, expected) > sidak(kSignificance, 4));
        CHECK(cosine.agrees(double(g), 1e-5));
        CHECK(second.agrees(double(g) * double(g), 1e-4)); // moments are powers of g
    }
}

TEST_CASE("phase: droplets scatter all light, with the mean cosine that is stated",
          "[integrators][media]")
{
    for (const float size : {1.0f, 5.0f, 10.0f, 20.0f, 50.0f, 90.0f})
    {
        const Phase phase = dropletPhase(size);
        double sum = 0.0, cosine = 0.0;
        constexpr int kSteps =
            400000; // in log(1 - cosTheta), as the peak of 50 micrometres is narrow
        const double least = std::log(1e-12), most = std::log(2.0);
        for (int i = 0; i < kSteps; ++i)
        {
            const double t = std::exp(least + (i + 0.5) * (most - least) / kSteps);
            // 1 - cosTheta has fewer digits as a float than the peak needs.
            const auto exact = [t](double g)
            { return (1 - g * g) / std::pow((1 - g) * (1 - g) + 2 * g * t, 1.5) / 12.566370614; };
            const double z = 1.0 - t, draine = exact(double(phase.draineG)) *
                                               double(draineFactor(phase, float(z)));
            const double plain = exact(double(phase.g));
            const double p = plain + double(phase.draineShare) * (draine - plain);
            if (t > 1e-3) CHECK(double(evalPhase(phase, float(z))) == Approx(p).epsilon(1e-3));
            sum += 6.283185307 * p * t * (most - least) / kSteps;
            cosine += 6.283185307 * p * t * z * (most - least) / kSteps;
        }
        CAPTURE(size);
        CHECK(sum == Approx(1.0).margin(1e-5));
        CHECK(cosine == Approx(double(meanCosine(phase))).margin(2e-5));
    }
    CHECK(dropletPhase(1.0f) == dropletPhase(kSmallestDroplet));
    CHECK(dropletPhase(90.0f) == dropletPhase(kLargestDroplet));
    CHECK(dropletPhase(10.0f).g == Approx(0.988177).epsilon(1e-5)); // [Jendersie23]
    CHECK(dropletPhase(10.0f).draineG == Approx(0.555671).epsilon(1e-5));
    CHECK(dropletPhase(10.0f).draineAlpha == Approx(21.99552).epsilon(1e-5));
    CHECK(dropletPhase(10.0f).draineShare == Approx(0.481955).epsilon(1e-5));
    // More light goes back than to the side.
    CHECK(evalPhase(dropletPhase(20.0f), -1.0f) > 2.0f * evalPhase(dropletPhase(20.0f), -0.3f));
}

TEST_CASE("phase: samples of droplets have the density that is evaluated",
          "[integrators][statistics][media]")
{
    Uniform random(7);
    const Vec3 axis = glm::normalize(Vec3(0.3f, -0.5f, 0.8f));
    std::vector<Phase> phases = {dropletPhase(5.0f), dropletPhase(12.0f), dropletPhase(50.0f)};
    for (const float g : {-0.7f, 0.02f, 0.5f, 0.9f})
        for (const float alpha : {0.0f, 0.01f, 1.0f, 30.0f})
        {
            Phase draine(g);
            draine.draineG = g;
            draine.draineAlpha = alpha;
            draine.draineShare = 1.0f;
            phases.push_back(draine);
        }
    for (const Phase& phase : phases)
    {
        std::vector<double> counts(kCells);
        Estimate cosine;
        for (int i = 0; i < kSamples; ++i)
        {
            const float u = random(), v = random();
            const double z = double(glm::dot(samplePhase(phase, axis, u, v), axis));
            cosine.add(z);
            // Cells of equal width in the square root, as droplets have a narrow peak.
            count(counts, std::sqrt(std::max(0.0, 0.5 * (1.0 - z))), 0.0, 1.0);
        }
        const auto expected = expectedCounts(
            [&phase](double s)
            { return 4.0 * s * 6.283185307 * double(evalPhase(phase, float(1.0 - 2.0 * s * s))); },
            0.0, 1.0);
        CAPTURE(phase.draineG, phase.draineAlpha, phase.draineShare);
        CHECK(chiSquareTest(counts, expected) > sidak(kSignificance, 19));
        CHECK(cosine.agrees(double(meanCosine(phase)), 1e-5));
    }
}

TEST_CASE("phase: Draine's function without alpha is that of Henyey and Greenstein",
          "[integrators][media]")
{
    Phase phase(0.6f);
    phase.draineG = 0.6f;
    phase.draineShare = 0.5f;
    for (int i = 0; i <= 20; ++i)
    {
        const float z = static_cast<float>(i) / 10.0f - 1.0f;
        CHECK(evalPhase(phase, z) == Approx(evalPhase(0.6f, z)).epsilon(1e-6));
    }
    CHECK(meanCosine(phase) == Approx(0.6f));
    CHECK(sampleDraine(0.6f, 0.0f, 0.3f) == sampleHenyeyGreenstein(0.6f, 0.3f));
    CHECK(sampleDraine(0.6f, 2e-3f, 0.3f) ==
          Approx(sampleHenyeyGreenstein(0.6f, 0.3f)).margin(2e-3));
}

TEST_CASE("free flights: three channels, and flights that must collide",
          "[integrators][statistics][media]")
{
    Uniform random(2);
    const Vec3 sigmas[] = {Vec3(1.0f), Vec3(0.5f, 2.0f, 8.0f), Vec3(0.0f, 1.0f, 3.0f)};
    const float length = 1.5f;
    for (const Vec3 sigma : sigmas)
        for (const bool within : {false, true})
        {
            const Vec3 pmf(0.5f, 0.3f, 0.2f);
            std::vector<double> counts(kCells);
            Estimate through[3], absorbed[3];
            for (int i = 0; i < kSamples; ++i)
            {
                const float u = random();
                const FreeFlight flight = within ? sampleFlightWithin(sigma, length, pmf, u)
                                                 : sampleFlight(sigma, length, pmf, u);
                if (flight.collides) count(counts, double(flight.distance), 0.0, double(length));
                for (int c = 0; c < 3; ++c)
                {
                    through[c].add(flight.collides ? 0.0 : double(flight.weight[c]));
                    absorbed[c].add(flight.collides ? double(flight.weight[c] * sigma[c]) : 0.0);
                }
            }
            const double hit = within ? double(collisionProbability(sigma, length, pmf)) : 1.0;
            const auto density = [&](double t)
            {
                double sum = 0.0;
                for (int c = 0; c < 3; ++c)
                    sum += double(pmf[c] * sigma[c]) * std::exp(-double(sigma[c]) * t);
                return sum / hit;
            };
            CAPTURE(sigma.x, sigma.y, within);
            CHECK(chiSquareTest(counts, expectedCounts(density, 0.0, double(length))) >
                  sidak(kSignificance, 6));
            for (int c = 0; c < 3; ++c)
            {
                const double left = std::exp(-double(sigma[c]) * double(length));
                CHECK(absorbed[c].agrees(1.0 - left, 1e-5));
                if (!within) CHECK(through[c].agrees(left, 1e-5));
            }
        }
}

TEST_CASE("free flights: no depth makes a weight that is not finite", "[integrators][media]")
{
    Uniform random(3);
    for (const float sigma : {0.0f, 1e-30f, 1e-9f, 1.0f, 1e6f, 1e24f})
        for (const float length : {1e-6f, 1.0f, 1e6f})
            for (int i = 0; i < 64; ++i)
            {
                const Vec3 grey(sigma), coloured(sigma, 0.5f * sigma, 2.0f * sigma);
                const float u = i == 0 ? 0.0f : i == 1 ? kOneMinusEpsilon : random();
                for (const Vec3& s : {grey, coloured})
                    for (const Vec3& pmf : {Vec3(1.0f / 3), Vec3(1, 0, 0)})
                    {
                        for (const FreeFlight& flight : {sampleFlight(s, length, pmf, u),
                                                         sampleFlightWithin(s, length, pmf, u)})
                        {
                            CHECK(glm::dot(flight.weight, Vec3(1.0f)) < kInfinity);
                            CHECK(flight.distance >= 0.0f);
                            CHECK(flight.distance <= length);
                        }
                        const Vec3 left = transmittance(s, length);
                        CHECK((left.x >= 0.0f && left.x <= 1.0f));
                        CHECK(emittedAlong(Vec3(1.0f), s, length).x <= length * 1.0001f);
                    }
            }
}

TEST_CASE("free flights: the optical depth of a number keeps its digits", "[integrators][media]")
{
    CHECK(depthOf(0.0f) == 0.0f);
    double worst = 0.0;
    for (double u = 1e-20; u < 1.0; u *= 1.003)
        worst = std::max(
            worst, std::fabs(double(depthOf(float(u))) / -std::log1p(-double(float(u))) - 1.0));
    CHECK(worst < 2.5e-7);
    CHECK(depthOf(kOneMinusEpsilon) == Approx(24.0 * std::log(2.0)));
}

TEST_CASE("equiangular points have the density that is evaluated",
          "[integrators][statistics][media]")
{
    Uniform random(4);
    const Vec3 lights[] = {Vec3(2, 1, 0), Vec3(-3, 0.2f, 0), Vec3(1.5f, 0, 0), Vec3(9, 4, 2)};
    for (const Vec3& light : lights)
    {
        const Equiangular stretch({0, 0, 0}, {1, 0, 0}, 0.5f, 4.0f, plainOf(light));
        std::vector<double> counts(kCells);
        for (int i = 0; i < kSamples; ++i)
        {
            const EquiangularSample sample = stretch.sample(random());
            REQUIRE(sample.pdf == stretch.pdf(sample.t));
            count(counts, double(sample.t), 0.5, 4.0);
        }
        const auto density = [&](double t) { return double(stretch.pdf(float(t))); };
        CAPTURE(light.x, light.y);
        if (light.y > 0.0f) // on the ray itself the peak is narrower than cells
            CHECK(chiSquareTest(counts, expectedCounts(density, 0.5, 4.0)) >
                  sidak(kSignificance, 3));
        CHECK(counts[0] + counts[kCells / 2] > 0.0);
    }
}

TEST_CASE("equiangular points: stretches far from the light keep their digits",
          "[integrators][media]")
{
    constexpr double kHeight = 1.0, kFar = 1000.0;
    for (const double foot : {-kFar, 0.5, 1.0 + kFar})
    {
        const Equiangular stretch({0, 0, 0}, {1, 0, 0}, 0.0f, 1.0f,
                                  {float(foot), float(kHeight), 0.0f});
        const double angle = std::atan2(1.0 - foot, kHeight) - std::atan2(-foot, kHeight);
        for (const float u : {0.0f, 0.25f, 0.5f, 0.999f})
        {
            CAPTURE(foot, u);
            const EquiangularSample sample = stretch.sample(u);
            const double along = double(sample.t) - foot;
            CHECK(double(sample.pdf) ==
                  Approx(kHeight / (angle * (kHeight * kHeight + along * along))).epsilon(1e-3));
            const double exact =
                foot + kHeight * std::tan(std::atan2(-foot, kHeight) + angle * double(u));
            CHECK(double(sample.t) == Approx(exact).margin(1e-3));
        }
    }
}

TEST_CASE("medium stack: a set of four, in the order of entry", "[integrators][media]")
{
    MediumStack stack;
    CHECK(stack.isEmpty());
    stack = stack.entered(7).entered(3).entered(7);
    CHECK(stack[0] == 7);
    CHECK(stack[2] == 7);
    CHECK(stack.left(7)[0] == 7); // the last one is left
    CHECK(stack.left(7)[2] == kOutside);
    CHECK(stack.left(3)[1] == 7);
    CHECK(stack.left(9).word() == stack.word());
    const MediumStack full = stack.entered(5);
    CHECK(full.isFull());
    CHECK(full.entered(1).word() == full.word());
    CHECK(full.left(5).word() == stack.word());
    CHECK(full.begunIn(1).word() == full.word());
    CHECK(stack.begunIn(2)[0] == 2);
    CHECK(stack.begunIn(2)[3] == 7);
    CHECK(full.left(7)[2] == 5);
}
