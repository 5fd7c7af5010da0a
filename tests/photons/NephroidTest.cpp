// NephroidTest.cpp - the caustic of a concave mirror wall compared with its closed form.
// SPDX-License-Identifier: MIT
#include "tests/photons/Nephroid.h"
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/photons/PhotonPasses.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// The discs are so large that G varies little in them: each gathers one per cent of the light or
/// more.
struct Row
{
    double x, gain, radius;
};
constexpr Row kTable[] = {{0.10, 1.25, 0.10},    {0.25, 2.0, 0.10}, {0.40, 5.0, 0.05},
                          {0.60, 9.54545, 0.05}, {0.75, 3.6, 0.08}, {0.90, 2.14286, 0.08}};
constexpr std::size_t kRows = 6;

/// Returns the light by the wall over direct light, in each row, with one value for each of 8
/// seeds. The views share their photons.
std::vector<Estimate> measuredGains(IntegratorKind kind, int passes)
{
    constexpr double kSide = 1e-3;
    const auto traced = nephroid().build();
    const auto workers = std::make_shared<Workers>(0);
    std::vector<Estimate> gains(kRows);
    for (uint32_t seed = 0; seed < 8; ++seed)
    {
        const auto photons = std::make_shared<PhotonPasses>();
        std::vector<std::unique_ptr<RenderSession>> sessions;
        for (const Row& row : kTable)
        {
            RenderOptions options =
                optionsOf(kind, 2, seed); // light of the floor does not come back by the wall
            options.photons = 1 << 16;
            options.photonRadius = static_cast<float>(row.radius);
            options.photonAlpha = 1.0f; // all passes have the same disc
            sessions.push_back(std::make_unique<RenderSession>(workers, photons));
            sessions.back()->setScene(traced);
            sessions.back()->setView(patchView({row.x, 0, 0}, {0, 0, 1}, kSide, 1));
            sessions.back()->setOptions(options);
        }
        for (int pass = 1; pass <= passes; ++pass)
            for (const auto& session : sessions)
            {
                StopRule rule;
                rule.passes = pass;
                const RenderProgress progress = session->render(rule);
                REQUIRE(progress.passes == pass);
                REQUIRE(progress.droppedSamples == 0);
            }
        for (std::size_t k = 0; k < kRows; ++k)
        {
            CHECK(double(sessions[k]->progress().photonRadius) == Approx(kTable[k].radius));
            gains[k].add(double(sessions[k]->resolveRadiance()[1]) - 1.0);
        }
    }
    return gains;
}

} // namespace

TEST_CASE("nephroid: the mean over a disc tends to the closed form", "[photons]")
{
    for (const Row& row : kTable)
    {
        CAPTURE(row.x);
        CHECK(gainOnAxis(row.x) == Approx(row.gain).epsilon(1e-5));
        CHECK(meanGain(row.x, 0.0, 0.002) == Approx(row.gain).epsilon(2e-3));
    }
    // At the place next to the caustic, this is G with the kernel's bias.
    CHECK(meanGain(0.6, 0.0, 0.01) == Approx(9.608).epsilon(2e-3));
}

// The bound is 1 %, as the table demands, and the standard error is at most a quarter of it: a
// false alarm of all twelve comparisons has a probability below 1e-3.
TEST_CASE("nephroid: irradiance at six places of the axis", "[photons][statistics]")
{
    for (const IntegratorKind kind : {IntegratorKind::PhotonCaustics, IntegratorKind::Sppm})
    {
        const std::vector<Estimate> gains =
            measuredGains(kind, kind == IntegratorKind::Sppm ? 48 : 24);
        for (std::size_t k = 0; k < kRows; ++k)
        {
            const double expected = meanGain(kTable[k].x, 0.0, kTable[k].radius);
            CAPTURE(int(kind), kTable[k].x, gains[k].mean(), expected, kTable[k].gain,
                    gains[k].standardError());
            CHECK(gains[k].standardError() < 2.5e-3 * expected);
            CHECK(std::abs(gains[k].mean() - expected) < 0.01 * expected);
        }
    }
}
