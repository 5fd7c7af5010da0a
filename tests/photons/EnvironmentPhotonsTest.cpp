// EnvironmentPhotonsTest.cpp - photons from environments compared with formulas and with paths.
// SPDX-License-Identifier: MIT
#include "tests/Environments.h"
#include "tests/PValues.h"
#include "tests/photons/PhotonMeans.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

SceneBuilder glassOnFloor(const std::shared_ptr<const EnvironmentImage>& image)
{
    SceneBuilder builder;
    builder.add(quadMesh({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), lambert(Vec3(0.7f)));
    builder.add(boxMesh({-1.4f, -0.4f, 0}, {-0.7f, 0.4f, 0.9f}), lambert(Vec3(0.3f, 0.6f, 0.3f)));
    builder.add(sphereMesh({0.4f, 0, 0.7f}, 0.6f, 32), glass(1.5f));
    builder.addLight(environmentLight(image, tilted(0.3f)));
    return builder;
}

View glassView()
{
    return perspectiveView({0, -5, 3}, {0, 0, 0.4}, {0, 0, 1}, 36.0, 24, 24);
}

} // namespace

TEST_CASE("photons and paths agree: glass under a sky with a sun", "[photons][statistics]")
{
    const auto traced = glassOnFloor(sunnySky(16, 8)).build();
    RenderOptions options = optionsOf(IntegratorKind::Path, 12);
    options.terminatorCorrection = false; // no photon lands below the plane of a facet
    const Estimate path = meanOf(traced, glassView(), options, 96);
    CHECK(path.standardError() < 6e-3 * path.mean());
    const double threshold = sidak(0.01, 2);
    for (const IntegratorKind kind : {IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
    {
        options.integrator = kind;
        options.photons = 10000;
        options.photonRadius = kind == IntegratorKind::Sppm ? 0.02f : 0.03f;
        const Estimate photons = meanOf(traced, glassView(), options, 12);
        const double p = welchTest(path, kRuns, photons, kRuns);
        CAPTURE(int(kind), path.mean(), path.standardError(), photons.mean(),
                photons.standardError(), p);
        CHECK(photons.standardError() < 0.015 * path.mean());
        CHECK(p > threshold);
    }
}

TEST_CASE("photons: an environment sends its integral times the scene's disc",
          "[photons][statistics]")
{
    // The power of all photons is the flux through the bounding sphere, guided or not: pi r^2 times
    // the integral.
    const auto image = sunnySky(32, 16);
    const auto traced = glassOnFloor(image).build();
    const std::vector<Light>& lights = traced->scene().lights;
    for (const float share : {0.0f, 0.5f})
    {
        const PhotonEmitter emitter(*traced, lights, share);
        REQUIRE(emitter.emits());
        const double radius = emitter.scene().radius;
        const double flux = EnvironmentMap(image).luminanceIntegral() * M_PI * radius * radius;
        Uniform uniform(4);
        Estimate power;
        int guided = 0;
        constexpr int kPhotons = 100000;
        for (int k = 0; k < kPhotons; ++k)
        {
            const float choice = uniform();
            const auto start =
                emitter.emit({uniform(), choice, {uniform(), uniform()}, {uniform(), uniform()}});
            power.add(start ? double(luminance(start->power)) : 0.0);
            if (!start) continue;
            // The photon starts outside of the scene and goes through the scene's sphere.
            const Vec3 d = emitter.scene().centre - start->origin;
            const float along = glm::dot(d, start->direction);
            CHECK(along > radius);
            CHECK(glm::length(d - start->direction * along) < radius * 1.001);
            const Vec3 ball = Vec3(0.4f, 0, 0.7f) - start->origin;
            guided +=
                glm::length(ball - start->direction * glm::dot(ball, start->direction)) < 0.6f;
        }
        CAPTURE(share, flux, power.mean(), power.standardError(), guided);
        CHECK(power.agrees(flux, 1e-4 * flux));
        CHECK((share == 0.0f ? guided < 0.1 * kPhotons : guided > 0.5 * kPhotons));
    }
}

TEST_CASE("photons: a black environment emits none", "[photons][stability 30]")
{
    const auto traced = glassOnFloor(newEnvironment(8, 4, Vec3(0.0f))).build();
    CHECK_FALSE(PhotonEmitter(*traced, traced->scene().lights, 0.5f).emits());
}
