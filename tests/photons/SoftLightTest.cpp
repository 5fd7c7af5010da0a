// SoftLightTest.cpp - photons of lights with a size: power, guiding, and agreement with paths.
// SPDX-License-Identifier: MIT
#include "tests/PValues.h"
#include "tests/photons/PhotonMeans.h"

#include "osgRayTrace/shading/SoftLight.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr double kPiD = glm::pi<double>();

Light softSpot(Vec3 position, Vec3 direction)
{
    Light light = pointLight(position, Vec3(1.0f, 0.9f, 0.8f));
    light.radius = 0.8f;
    light.direction = glm::normalize(direction);
    light.spotCosCutoff = std::cos(glm::radians(50.0f));
    light.spotExponent = 2.0f;
    light.attenuationConstant = 1.0f; // OpenGL's default: the light does not fade
    light.attenuationQuadratic = 0.0f;
    return light;
}

Light softSun(Vec3 direction)
{
    Light light;
    light.kind = LightKind::Directional;
    light.direction = glm::normalize(direction);
    light.diffuse = Vec3(0.8f, 0.9f, 1.0f);
    light.sine = 0.3f;
    return light;
}

/// Returns the flux of the light above a floor with a glass ball as a target.
Flux emitted(const Light& light, float guidedShare, double& sceneRadius)
{
    SceneBuilder builder;
    builder.add(quadMesh({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), lambert(Vec3(0.5f)));
    builder.add(sphereMesh(kBall, kBallRadius, 16), glass(1.5f));
    builder.addLight(light);
    const auto traced = builder.build(1);
    const PhotonEmitter emitter(*traced, traced->scene().lights, guidedShare);
    sceneRadius = emitter.scene().radius;
    return emittedFlux(emitter, 29);
}

/// Returns a closed room with a block and a rough block of metal.
SceneBuilder room()
{
    SceneBuilder builder;
    auto walls = boxMesh({-2, -2, 0}, {2, 2, 3});
    std::vector<UVec3> inside(walls->triangles.begin(), walls->triangles.end());
    for (UVec3& t : inside)
        std::swap(t.y, t.z);
    walls->triangles = std::move(inside);
    builder.add(walls, lambert(Vec3(0.6f, 0.5f, 0.4f)));
    builder.add(boxMesh({-1, -0.5f, 0}, {-0.3f, 0.4f, 1.2f}), lambert(Vec3(0.7f)));
    Material metal = lambert(Vec3(0.9f, 0.8f, 0.7f));
    metal.metallic = 1.0f;
    metal.roughness = 0.6f;
    builder.add(boxMesh({0.4f, 0.2f, 0}, {1.1f, 0.9f, 0.8f}), metal);
    return builder;
}

/// Returns a floor and a block in the open, for suns.
SceneBuilder yard()
{
    SceneBuilder builder;
    builder.add(quadMesh({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), lambert(Vec3(0.6f, 0.5f, 0.4f)));
    builder.add(boxMesh({-1, -0.5f, 0}, {-0.3f, 0.4f, 1.2f}), lambert(Vec3(0.7f)));
    builder.add(quadMesh({-2, 1.5f, 0}, {4, 0, 0}, {0, 0, 3}), lambert(Vec3(0.3f, 0.5f, 0.7f)));
    return builder;
}

View insideView()
{
    return perspectiveView({0.3, -1.9, 1.6}, {0, 0.4, 0.6}, {0, 0, 1}, 70, 24, 24);
}

/// Checks that photons agree with paths. The two scenes have six comparisons, of which one in a
/// hundred runs raises a false alarm.
void checkAgreement(const std::shared_ptr<const TracedScene>& traced)
{
    const double threshold = sidak(0.01, 6);
    RenderOptions options = optionsOf(IntegratorKind::Path, 12);
    const Estimate path = meanOf(traced, insideView(), options, 32);
    REQUIRE(path.mean() > 0.02);
    for (const IntegratorKind kind :
         {IntegratorKind::Sppm, IntegratorKind::Ppm, IntegratorKind::PhotonCaustics})
    {
        options.integrator = kind;
        options.photons = 8000;
        options.photonRadius = 0.03f;
        const Estimate photons = meanOf(traced, insideView(), options, 12);
        const double p = welchTest(path, kRuns, photons, kRuns);
        CAPTURE(int(kind), path.mean(), path.standardError(), photons.mean(),
                photons.standardError(), p);
        CHECK(photons.standardError() < 0.01 * path.mean());
        CHECK(p > threshold);
    }
}

} // namespace

TEST_CASE("photons of soft lights: all power leaves, guided or not", "[photons][statistics]")
{
    Light ball = pointLight({-0.5f, 0.3f, 2.0f});
    ball.radius = 0.7f;
    for (const Light& light : {ball, softSun({0.3f, 0.2f, -1.0f})})
    {
        double radius = 0.0;
        const Flux plain = emitted(light, 0.0f, radius);
        const double expected = light.kind == LightKind::Point
                                    ? 4.0 * kPiD * kPiD
                                    : kPiD * 0.9 * kPiD * radius * radius * softWeight(light.sine);
        CAPTURE(int(light.kind), plain.total.mean(), plain.total.standardError(), expected);
        CHECK(plain.total.agrees(expected, 1e-5 * expected));
        for (const float share : {0.25f, 0.9f})
        {
            const Flux guided = emitted(light, share, radius);
            const double spread =
                std::hypot(plain.ball.standardError(), guided.ball.standardError());
            CAPTURE(share, guided.total.mean(), plain.ball.mean(), guided.ball.mean(), spread);
            CHECK(guided.total.agrees(expected, 1e-5 * expected));
            CHECK(plain.ball.mean() > 0.0);
            CHECK(std::abs(plain.ball.mean() - guided.ball.mean()) <= 4.0 * spread);
            if (share > 0.5f) CHECK(guided.ball.standardError() < plain.ball.standardError());
        }
    }
}

// A wall goes through the light's sphere, so that some surfaces are inside of it.
TEST_CASE("photons of soft lights: a spot that fades in its own way, as paths see it",
          "[photons][statistics]")
{
    SceneBuilder builder = room();
    builder.addLight(softSpot({0.2f, -0.3f, 2.7f}, {-0.2f, 0.2f, -1.0f}));
    checkAgreement(builder.build());
}

TEST_CASE("photons of soft lights: a sun, as paths see it", "[photons][statistics]")
{
    SceneBuilder builder = yard();
    builder.addLight(softSun({0.5f, 0.6f, -1.0f}));
    checkAgreement(builder.build());
}
