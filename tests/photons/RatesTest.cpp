// RatesTest.cpp - how fast the error of rendered photon maps falls: slopes, bias and variance by
// the formulas.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"
#include "tests/photons/KnownPatches.h"
#include "tests/photons/Nephroid.h"

#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/photons/RadiusSchedule.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kPixels = 16; ///< an edge of the patch that is looked at
constexpr double kPiD = glm::pi<double>();
constexpr int kCounts[] = {64, 128, 256, 512, 1024, 2048, 4096};
constexpr std::size_t kLast = 6;

/// Holds the means, over the pixels, of the error over the true value and of its square at each of
/// kCounts, with one value a run.
struct Errors
{
    std::vector<Estimate> relative, squared;
    std::vector<double> slopes; ///< of the squared error, one a run
};

Errors measured(const KnownPatch& known, RenderOptions options, int runs)
{
    const auto traced = known.builder.build();
    const std::vector<double> expected = truth(known, kPixels);
    Errors errors;
    errors.relative.resize(kLast + 1);
    errors.squared.resize(kLast + 1);
    for (int run = 0; run < runs; ++run)
    {
        RenderSession session(std::make_shared<Workers>(1));
        session.setScene(traced);
        session.setView(viewOf(known, kPixels));
        options.seed = 77 + static_cast<uint32_t>(run);
        session.setOptions(options);
        std::vector<double> counts, squares;
        for (std::size_t at = 0; at <= kLast; ++at)
        {
            StopRule rule;
            rule.passes = kCounts[at];
            const RenderProgress progress = session.render(rule);
            REQUIRE(progress.passes == kCounts[at]);
            REQUIRE(progress.droppedSamples == 0);
            const std::vector<float> rgba = session.resolveRadiance();
            double relative = 0.0, squared = 0.0;
            for (std::size_t k = 0; k < expected.size(); ++k)
            {
                const double error = double(rgba[4 * k + 1]) / expected[k] - 1.0;
                relative += error / double(expected.size());
                squared += error * error / double(expected.size());
            }
            errors.relative[at].add(relative);
            errors.squared[at].add(squared);
            counts.push_back(kCounts[at]);
            squares.push_back(squared);
        }
        errors.slopes.push_back(logLogSlope(counts, squares));
    }
    return errors;
}

void checkSlope(const char* name, const Errors& errors, const RenderOptions& options)
{
    Estimate slope;
    for (const double s : errors.slopes)
        slope.add(s);
    std::vector<double> counts, squares;
    for (std::size_t at = 0; at <= kLast; ++at)
    {
        counts.push_back(kCounts[at]);
        squares.push_back(errors.squared[at].mean());
    }
    const double fitted = logLogSlope(counts, squares);
    CAPTURE(name, int(options.integrator), int(options.radiusSchedule), options.photonAlpha, fitted,
            slope.standardError(), squares[0], squares[kLast]);
    CHECK(slope.standardError() < 0.02);
    CHECK(fitted == Approx(-double(options.photonAlpha)).margin(0.07));
}

/// Returns the power of a photon that comes by the mirror: all photons have the same [W].
double photonPower(const KnownPatch& known, const RenderOptions& options)
{
    const auto traced = known.builder.build();
    PhotonPassOptions pass;
    pass.use = PhotonUse::Caustics;
    pass.photons = static_cast<uint32_t>(options.photons);
    pass.maxBounces = 2;
    PhotonPasses passes;
    const auto first = passes.pass({traced, &traced->scene().lights, pass}, 0, 0.1f, Workers(1));
    REQUIRE(first->map.size() > 10);
    return double(first->map.photon(0).power.y);
}

/// Returns the mean, over the pixels, of variance and squared bias over the squared value after
/// count passes. Pass i has a disc of r_i^2 = r_1^2 globalRadiusSquared(i), whose photons are
/// Poisson distributed.
double expectedSquare(const KnownPatch& known, const RenderOptions& options, double power,
                      int count)
{
    const std::vector<double> expected = truth(known, kPixels);
    double sum = 0.0;
    for (int k = 0; k < kPixels * kPixels; ++k)
    {
        const Vec3d p = pixelCentre(known, kPixels, k);
        double mean = 0.0, variance = 0.0;
        for (int i = 0; i < count; ++i)
        {
            const double radius2 = double(options.photonRadius) * double(options.photonRadius) *
                                   globalRadiusSquared(i, double(options.photonAlpha));
            const double inDisc = known.mean(p.x, p.y, std::sqrt(radius2));
            mean += inDisc / count;
            // A flux F = pi L of photons of power w through the disc A gives var(L) = w F A / (pi
            // A)^2.
            variance += power * inDisc / (kPiD * kPiD * radius2) / (double(count) * count);
        }
        const double bias = mean - known.mean(p.x, p.y, 0.0);
        const double value = expected[static_cast<std::size_t>(k)];
        sum += (variance + bias * bias) / (value * value) / (kPixels * kPixels);
    }
    return sum;
}

RenderOptions optionsFor(IntegratorKind kind, RadiusSchedule schedule, int photons, float radius)
{
    RenderOptions options = optionsOf(kind, 2);
    options.radiusSchedule = schedule;
    options.photons = photons;
    options.photonRadius = radius;
    // The formulas assume that all passes are alike: with guiding, later passes would be better.
    options.photonGuiding = false;
    return options;
}

} // namespace

// The slopes have a standard error of 0.02 at most: 0.07 is 3.5 of them, and a false alarm of all
// five has a probability of 2e-3. Mean squares are those of the formulas to 12 %: four standard
// errors, and some because photons are spread more evenly than by chance.
TEST_CASE("rates: a flat mirror's light by global radii", "[photons][statistics][stability 41]")
{
    const KnownPatch known = flatMirrorPatch();
    for (const float alpha : {0.5f, 2.0f / 3.0f, 0.8f})
    {
        RenderOptions options =
            optionsFor(IntegratorKind::PhotonCaustics, RadiusSchedule::Global, 256, 0.03f);
        options.photonAlpha = alpha;
        const Errors errors = measured(known, options, 6);
        checkSlope("flat mirror", errors, options);
        const double power = photonPower(known, options);
        for (const std::size_t at : {std::size_t(2), std::size_t(4), kLast})
        {
            const double expected = expectedSquare(known, options, power, kCounts[at]);
            CAPTURE(alpha, kCounts[at], errors.squared[at].mean(), expected,
                    errors.squared[at].standardError());
            CHECK(errors.squared[at].mean() == Approx(expected).epsilon(0.12));
        }
    }
}

TEST_CASE("rates: a flat mirror's light by local radii", "[photons][statistics][stability 41]")
{
    const RenderOptions options =
        optionsFor(IntegratorKind::Sppm, RadiusSchedule::Local, 1024, 0.06f);
    checkSlope("flat mirror", measured(flatMirrorPatch(), options, 8), options);
}

TEST_CASE("rates: the nephroid's light", "[photons][statistics][stability 41]")
{
    RenderOptions options =
        optionsFor(IntegratorKind::PhotonCaustics, RadiusSchedule::Global, 1024, 0.015f);
    checkSlope("nephroid", measured(nephroidPatch(), options, 6), options);
    options = optionsFor(IntegratorKind::Sppm, RadiusSchedule::Local, 1024, 0.02f);
    checkSlope("nephroid", measured(nephroidPatch(), options, 6), options);
}

// At a place beside the nephroid the first disc holds 30 % too much light. The mean of the discs'
// means over the passes must be right within four standard errors of 32 values (a false alarm of
// the three: 1e-3).
TEST_CASE("rates: bias beside the nephroid falls as the discs do", "[photons][statistics]")
{
    const auto traced = nephroid().build();
    RenderOptions options =
        optionsFor(IntegratorKind::PhotonCaustics, RadiusSchedule::Global, 1024, 0.05f);
    constexpr int counts[] = {64, 256, 1024};
    Estimate gains[3];
    for (uint32_t run = 0; run < 32; ++run)
    {
        RenderSession session(std::make_shared<Workers>(1));
        session.setScene(traced);
        session.setView(patchView({0.6, 0, 0}, {0, 0, 1}, 1e-3, 1));
        options.seed = run;
        session.setOptions(options);
        for (int at = 0; at < 3; ++at)
        {
            StopRule rule;
            rule.passes = counts[at];
            session.render(rule);
            gains[at].add(double(session.resolveRadiance()[1]) - 1.0);
        }
    }
    double sum = 0.0;
    for (int i = 0, at = 0; i < counts[2]; ++i)
    {
        sum += meanGain(0.6, 0.0, 0.05 * std::sqrt(globalRadiusSquared(i, 2.0 / 3.0)), 4000);
        if (i + 1 != counts[at]) continue;
        const double expected = sum / (i + 1), bias = expected - gainOnAxis(0.6);
        CAPTURE(i + 1, gains[at].mean(), expected, bias, gains[at].standardError());
        CHECK(gains[at].standardError() < 0.2 * bias);
        CHECK(gains[at].agrees(expected, 2e-3 * expected));
        ++at;
    }
}
