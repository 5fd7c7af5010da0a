// BiasEstimateTest.cpp - the error that a session states holds the bias of photon look-ups.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/PValues.h"
#include "tests/photons/KnownPatches.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr uint32_t kSeeds = 4;
const std::vector<int> kPasses = {16, 48};

/// Returns ErrorEstimate::relative of an image against its truth, grey, row by row.
double trueError(const std::vector<float>& image, const std::vector<double>& truth, int pixels)
{
    double sum = 0.0;
    for (int tile = 0; tile < pixels * pixels / 256; ++tile)
    {
        double squares = 0.0, mean = 0.0;
        for (int k = 0; k < 256; ++k)
        {
            const int x = tile % (pixels / 16) * 16 + k % 16;
            const int y = tile / (pixels / 16) * 16 + k / 16;
            const auto at = static_cast<std::size_t>(y * pixels + x);
            squares += std::pow(double(image[4 * at + 1]) - truth[at], 2);
            mean += truth[at] / 256.0;
        }
        sum += squares / (mean * mean + 0.01);
    }
    return std::sqrt(sum / (pixels * pixels));
}

struct Stated
{
    double stated2 = 0.0, true2 = 0.0; ///< means over the seeds
    int uncovered = 0; ///< seeds whose true error is 1.5 times the stated one or more
};

/// Returns for each of kPasses what sessions state, and the truth.
std::vector<Stated> statedErrors(const KnownPatch& patch, const RenderOptions& base, int pixels)
{
    const auto traced = patch.builder.build();
    const std::vector<double> expected = truth(patch, pixels);
    const auto workers = std::make_shared<Workers>(0);
    std::vector<Stated> result(kPasses.size());
    for (uint32_t seed = 0; seed < kSeeds; ++seed)
    {
        RenderOptions options = base;
        options.seed = seed;
        RenderSession session(workers);
        session.setScene(traced);
        session.setView(viewOf(patch, pixels));
        session.setOptions(options);
        for (std::size_t k = 0; k < kPasses.size(); ++k)
        {
            StopRule rule;
            rule.passes = kPasses[k];
            REQUIRE(session.render(rule).passes == kPasses[k]);
            const double stated = session.estimateError().relative;
            const double actual = trueError(session.resolveRadiance(), expected, pixels);
            result[k].stated2 += stated * stated / kSeeds;
            result[k].true2 += actual * actual / kSeeds;
            result[k].uncovered += actual > 1.5 * stated;
        }
    }
    return result;
}

/// Checks that the stated error is the true one in the root mean square, from 0.7 to 1.75 times,
/// and that at most one of the seeds' true errors is 1.5 times the stated one or more. A quarter of
/// the pixels compare discs, which is the reason for most of that range: the patches have few
/// tiles, and most of the bias is in some of them.
void checkStated(const KnownPatch& patch, const RenderOptions& options, int pixels)
{
    const std::vector<Stated> all = statedErrors(patch, options, pixels);
    for (std::size_t k = 0; k < all.size(); ++k)
    {
        const double stated = std::sqrt(all[k].stated2), actual = std::sqrt(all[k].true2);
        CAPTURE(int(options.integrator), kPasses[k], stated, actual, stated / actual);
        CHECK(stated / actual > 0.7);
        CHECK(stated / actual < 1.75);
        CHECK(all[k].uncovered <= 1);
    }
}

RenderOptions optionsFor(IntegratorKind kind, RadiusSchedule schedule, int photons, float radius)
{
    RenderOptions options = optionsOf(kind, 2);
    options.radiusSchedule = schedule;
    options.photons = photons;
    options.photonRadius = radius;
    return options;
}

/// Counts pictures by how their true error compares with the stated one.
struct Covered
{
    int pictures = 0, above = 0, below = 0;
};

/// Renders pictures of a patch with independent seeds, half of them with 8 passes, the others with
/// 32, and the radii that the scene gives.
void countCovered(const KnownPatch& patch, IntegratorKind kind, Covered& covered)
{
    constexpr int kPixels = 48;
    constexpr uint32_t kPictures = 8;
    const auto traced = patch.builder.build();
    const std::vector<double> expected = truth(patch, kPixels);
    RenderOptions options = optionsFor(kind, RadiusSchedule::Global, 1 << 15, 0.0f);
    for (options.seed = 0; options.seed < kPictures; ++options.seed)
    {
        const int passes = options.seed % 2 ? 32 : 8;
        RenderSession session(std::make_shared<Workers>(0));
        session.setScene(traced);
        session.setView(viewOf(patch, kPixels));
        session.setOptions(options);
        StopRule rule;
        rule.passes = passes;
        REQUIRE(session.render(rule).passes == passes);
        const double stated = session.estimateError().relative;
        const double ratio = trueError(session.resolveRadiance(), expected, kPixels) / stated;
        ++covered.pictures;
        covered.above += ratio > 1.4;
        covered.below += ratio < 0.7;
    }
}

/// Returns the probability of so many of n pictures or more if each is one of them with p.
double tailOf(int count, int n, double p)
{
    return count == 0 ? 1.0 : incompleteBeta(count, n - count + 1.0, p);
}

} // namespace

// The rate that is claimed: in nine of ten pictures the true error is at most 1.4 times the stated
// one, and in nine of ten it is at least 0.7 times. Either check fails by chance once in a thousand
// times if that is just met.
TEST_CASE("bias estimate: covers the true error in nine of ten pictures", "[photons][statistics]")
{
    Covered covered;
    for (const KnownPatch& patch : {flatMirrorPatch(), nephroidPatch(), causticPatch()})
        for (const IntegratorKind kind : {IntegratorKind::PhotonCaustics, IntegratorKind::Sppm})
            countCovered(patch, kind, covered);
    CAPTURE(covered.pictures, covered.above, covered.below);
    CHECK(tailOf(covered.above, covered.pictures, 0.1) > 1e-3);
    CHECK(tailOf(covered.below, covered.pictures, 0.1) > 1e-3);
}

TEST_CASE("bias estimate: of smooth light by a flat mirror", "[photons][statistics]")
{
    checkStated(flatMirrorPatch(),
                optionsFor(IntegratorKind::PhotonCaustics, RadiusSchedule::Global, 1 << 18, 0.3f),
                32);
}

// SPPM is left out here: its bias is about as great as its noise, and not seen with every seed.
TEST_CASE("bias estimate: inside of the nephroid", "[photons][statistics]")
{
    checkStated(nephroidPatch(),
                optionsFor(IntegratorKind::PhotonCaustics, RadiusSchedule::Global, 1 << 17, 0.08f),
                128);
}

TEST_CASE("bias estimate: on the curve of the nephroid", "[photons][statistics]")
{
    for (const IntegratorKind kind : {IntegratorKind::PhotonCaustics, IntegratorKind::Sppm})
        checkStated(causticPatch(), optionsFor(kind, RadiusSchedule::Global, 1 << 15, 0.02f), 128);
}
