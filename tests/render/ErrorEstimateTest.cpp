// ErrorEstimateTest.cpp - what a session says of its error is its error.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// mean((x - r)^2 / (r^2 + 0.01)) over pixels and RGB.
double relativeSquaredError(const std::vector<float>& image, const std::vector<float>& reference)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i)
    {
        if (i % 4 == 3) continue;
        const double d = double(image[i]) - reference[i], r = reference[i];
        sum += d * d / (r * r + 0.01);
    }
    return sum / (0.75 * static_cast<double>(image.size()));
}

struct Errors
{
    double estimated = 0.0, actual = 0.0; ///< means of squares over seeds
};

constexpr int kSize = 24;

/// Walls, floor and blocks of the box, but not its light.
View viewWithoutLight()
{
    return perspectiveView({278, 400, 20}, {278, 100, 559}, {0, 1, 0}, 45.0, kSize, kSize);
}

/// Demands that over 100 seeds the estimated error is the true one to 20 %, after each number of
/// passes.
void checkErrors(IntegratorKind kind, const View& view, const std::vector<int>& passCounts)
{
    const auto traced = cornellBox().build();
    RenderOptions options = optionsOf(kind, 4);
    options.lightSamples = 1;
    options.seed = 12345;
    const Picture reference = render(traced, view, options, 4096);
    REQUIRE(reference.progress.droppedSamples == 0);

    RenderSession session(std::make_shared<Workers>());
    session.setScene(traced);
    session.setView(view);
    std::vector<Errors> errors(passCounts.size());
    for (uint32_t seed = 0; seed < 100; ++seed)
    {
        options.seed = seed;
        session.setOptions(options);
        for (std::size_t i = 0; i < passCounts.size(); ++i)
        {
            StopRule rule;
            rule.passes = passCounts[i];
            const RenderProgress progress = session.render(rule);
            REQUIRE(progress.passes == passCounts[i]);
            REQUIRE(progress.droppedSamples == 0);
            const double estimate = session.estimateRelativeError();
            errors[i].estimated += estimate * estimate / 100.0;
            errors[i].actual +=
                relativeSquaredError(session.resolveRadiance(), reference.rgba) / 100.0;
        }
    }
    for (std::size_t i = 0; i < passCounts.size(); ++i)
    {
        const double estimated = std::sqrt(errors[i].estimated),
                     actual = std::sqrt(errors[i].actual);
        CAPTURE(passCounts[i], estimated, actual);
        CHECK(estimated / actual == Approx(1.0).margin(0.2));
    }
}

} // namespace

// Over 100 seeds of 1728 values each the ratio of the roots has a standard error below 3 %.

TEST_CASE("error estimate: within 20 % of the true error of path tracing", "[render][statistics]")
{
    checkErrors(IntegratorKind::Path, viewWithoutLight(), {4, 16, 64});
}

TEST_CASE("error estimate: within 20 % of the true error of Whitted's ray tracer",
          "[render][statistics]")
{
    checkErrors(IntegratorKind::Whitted, viewWithoutLight(), {4, 16, 64});
}

TEST_CASE("error estimate: and with the edges of the light in view, after some passes",
          "[render][statistics]")
{
    // Pixels that are bright in one pass out of many have their error underrated until more of
    // their passes were bright: see Film::relativeSquaredError.
    checkErrors(IntegratorKind::Path, cornellView(kSize, kSize), {64});
    checkErrors(IntegratorKind::Whitted, cornellView(kSize, kSize), {64});
}
