// PhotonMeans.h - estimates for tests of photons: the mean of pictures, and the flux that leaves
// lights.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/PValues.h"
#include "tests/Statistics.h"

#include "osgRayTrace/photons/PhotonEmitter.h"

namespace osgRayTrace::engine::test
{

constexpr int kRuns = 16;

/// Returns the mean luminance of the picture, with one value for each of kRuns seeds, which differ
/// from integrator to integrator. Requires that no sample was dropped.
inline Estimate meanOf(const std::shared_ptr<const TracedScene>& traced, const View& view,
                       RenderOptions options, int passes)
{
    Estimate estimate;
    for (uint32_t run = 0; run < kRuns; ++run)
    {
        options.seed = 1000 * (1 + static_cast<uint32_t>(options.integrator)) + run;
        const Picture picture = render(traced, view, options, passes);
        REQUIRE(picture.progress.droppedSamples == 0);
        REQUIRE(picture.progress.integrator == options.integrator);
        estimate.add(double(luminance(picture.mean())));
    }
    return estimate;
}

/// Checks that the means of two pictures agree: error bounds the standard error of each, relative
/// to the first mean; threshold is the probability of a false alarm.
inline void checkAgreement(const Estimate& a, const Estimate& b, double error, double threshold)
{
    const double p = welchTest(a, kRuns, b, kRuns);
    CAPTURE(a.mean(), a.standardError(), b.mean(), b.standardError(), p, threshold);
    CHECK(a.standardError() < error * a.mean());
    CHECK(b.standardError() < error * a.mean());
    CHECK(p > threshold);
}

inline EmissionPoint randomPoint(Uniform& uniform)
{
    EmissionPoint point;
    point.light = uniform();
    point.choice = uniform();
    point.position = Vec2(uniform(), uniform());
    point.direction = Vec2(uniform(), uniform());
    return point;
}

/// The ball serves as a target.
const Vec3 kBall(0.5f, 0.2f, 0.6f);
constexpr float kBallRadius = 0.4f;

struct Flux
{
    Estimate total; ///< of all photons
    Estimate ball;  ///< of the photons that meet the ball's sphere
};

inline Flux emittedFlux(const PhotonEmitter& emitter, uint32_t seed,
                        const PhotonGuide* photonGuide = nullptr)
{
    Uniform uniform(seed);
    Flux flux;
    for (int k = 0; k < 300000; ++k)
    {
        const auto start = emitter.emit(randomPoint(uniform), photonGuide);
        bool meets = false;
        if (start)
        {
            REQUIRE(std::fabs(glm::length(start->direction) - 1.0f) < 1e-5f);
            const Vec3 d = kBall - start->origin;
            const float along = glm::dot(d, start->direction);
            meets = along > 0.0f && glm::dot(d, d) - along * along < kBallRadius * kBallRadius;
        }
        flux.total.add(start ? double(start->power.y) : 0.0);
        flux.ball.add(meets ? double(start->power.y) : 0.0);
    }
    return flux;
}

} // namespace osgRayTrace::engine::test
