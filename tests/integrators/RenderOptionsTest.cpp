// RenderOptionsTest.cpp - which options restart an image, and samples of lights. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/integrators/shared/RenderOptions.h"

#include <tuple>

using namespace osgRayTrace::engine;

TEST_CASE("render options: what changes the image restarts it", "[integrators]")
{
    const RenderOptions before;
    // A new option does not compile here: it gets a line below.
    const auto& [o1, o2, o3, o4, o5, o6, o7, o8, o9, o10, o11, o12, o13, o14, o15, o16, o17, o18,
                 o19, o20, o21] = before;
    const auto options = std::tie(o1, o2, o3, o4, o5, o6, o7, o8, o9, o10, o11, o12, o13, o14, o15,
                                  o16, o17, o18, o19, o20, o21);
    CHECK(std::tuple_size<decltype(options)>::value ==
          std::tuple_size<decltype(before.restarting())>::value);
    CHECK_FALSE(before.needsRestart(before));
    const auto restarts = [&before](auto change)
    {
        RenderOptions after = before;
        change(after);
        return after.needsRestart(before);
    };
    CHECK(restarts([](RenderOptions& o) { o.integrator = IntegratorKind::Path; }));
    CHECK(restarts([](RenderOptions& o) { o.lightSampling = LightSampling::Random; }));
    CHECK(restarts([](RenderOptions& o) { o.debugChannel = DebugChannel::Id; }));
    CHECK(restarts([](RenderOptions& o) { o.lightSamples = 9; }));
    CHECK(restarts([](RenderOptions& o) { o.environmentSampling = EnvironmentSampling::Uniform; }));
    CHECK(restarts([](RenderOptions& o) { o.environmentSamples = 9; }));
    CHECK(restarts([](RenderOptions& o) { o.maxBounces = 1; }));
    CHECK(restarts([](RenderOptions& o) { o.shadows = false; }));
    CHECK(restarts([](RenderOptions& o) { o.terminatorCorrection = false; }));
    CHECK(restarts([](RenderOptions& o) { o.photonGuiding = false; }));
    CHECK(restarts([](RenderOptions& o) { o.centredFirstPass = true; }));
    CHECK(restarts([](RenderOptions& o) { o.still = true; }));
    CHECK(restarts([](RenderOptions& o) { o.moving = true; }));
    CHECK(restarts([](RenderOptions& o) { o.aperture = 1.0f; }));
    CHECK(restarts([](RenderOptions& o) { o.focus = 1.0f; }));
    CHECK(restarts([](RenderOptions& o) { o.seed = 1; }));
    CHECK(restarts([](RenderOptions& o) { o.photons = 9; }));
    CHECK(restarts([](RenderOptions& o) { o.photonRadius = 0.5f; }));
    CHECK(restarts([](RenderOptions& o) { o.photonAlpha = 0.5f; }));
    CHECK(restarts([](RenderOptions& o) { o.photonBeams = 9; }));
    CHECK(restarts([](RenderOptions& o) { o.radiusSchedule = RadiusSchedule::Local; }));
}

TEST_CASE("render options: strategies with cells take whole squares", "[integrators]")
{
    RenderOptions options;
    options.lightSamples = 5;
    options.lightSampling = LightSampling::Sobol;
    CHECK(lightSampleCount(options) == 5);
    options.lightSampling = LightSampling::Random;
    CHECK(lightSampleCount(options) == 5);
    options.lightSampling = LightSampling::Stratified;
    CHECK(lightSampleCount(options) == 9);
    options.lightSampling = LightSampling::UniformJitter;
    CHECK(lightSampleCount(options) == 9);
    options.lightSamples = 1;
    CHECK(lightSampleCount(options) == 1);
}
