// GridPhotonsTest.cpp - photons in scenes with volumes bring the light that paths find there.
// SPDX-License-Identifier: MIT
#include "tests/PValues.h"
#include "tests/integrators/VolumeScenes.h"
#include "tests/photons/BeamScenes.h"
#include "tests/photons/PhotonMeans.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

struct GridScene
{
    const char* name;
    SceneBuilder builder;
};

/// Adds clumps of smoke to a box of the Cornell box.
void addSmoke(SceneBuilder& builder, Vec3 low, Vec3 high, float density, float albedo, float g)
{
    builder.scene->volumes.push_back(
        densityIn(low, high, clumps(12), mediumOf(density, albedo, g)));
}

std::vector<GridScene> gridScenes()
{
    std::vector<GridScene> scenes;
    scenes.push_back({"smoke in coloured fog", foggyBox(0.6f, Vec3(0.9f, 0.6f, 0.3f))});
    SceneBuilder& fog = scenes.back().builder;
    fog.add(sphereMesh({400, 250, 120}, 90.0f, 24), glass(1.5f));
    fog.add(sphereMesh({150, 430, 300}, 90.0f, 24), mirror(Vec3(0.9f)));
    addSmoke(fog, {50, 100, 50}, {500, 300, 500}, 0.01f, 0.9f, 0.3f);
    addSmoke(fog, {300, 50, 20}, {520, 500, 300}, 0.005f, 0.7f, -0.4f);

    scenes.push_back({"smoke over bodies", cornellBox()});
    Material brushed = mirror(Vec3(0.8f));
    brushed.roughness = 0.2f;
    SceneBuilder& bodies = scenes.back().builder;
    bodies.add(sphereMesh({400, 250, 120}, 90.0f, 24), bodyOf(mediumOf(0.02f, 0.95f), 1.4f));
    bodies.add(boxMesh({60, 330, 200}, {250, 500, 400}), bodyOf(mediumOf(0.4f, 0.9f, 0.5f)));
    bodies.add(boxMesh({300, 400, 200}, {400, 450, 400}), brushed);
    addSmoke(bodies, {100, 20, 20}, {500, 450, 350}, 0.01f, 0.95f, 0.2f);

    // The smoke reaches through the boundary of a mist in which the light of a ball gathers.
    scenes.push_back({"smoke across mist", cornellBox()});
    SceneBuilder& mist = scenes.back().builder;
    mist.add(sphereMesh({300, 400, 250}, 90.0f, 24), glass(1.5f));
    mist.add(boxMesh({80, 60, 60}, {500, 300, 440}), bodyOf(mediumOf(0.004f, 0.9f, 0.3f)));
    addSmoke(mist, {240, 200, 200}, {420, 340, 320}, 0.02f, 0.9f, 0.0f);
    return scenes;
}

/// Returns the Cornell box under an even ceiling of smoke, with a glass ball beneath it.
SceneBuilder ballUnderSmoke()
{
    SceneBuilder builder = cornellBox();
    builder.add(sphereMesh({420, 160, 130}, 70.0f, 32), glass(1.5f));
    addSmoke(builder, {5, 300, 5}, {545, 500, 550}, 0.01f, 0.5f, 0.0f);
    addSmoke(builder, {300, 5, 20}, {545, 80, 260}, 0.01f, 0.9f, 0.0f);
    return builder;
}

} // namespace

// All comparisons together raise a false alarm with a probability of 1 %.
TEST_CASE("photons in volumes: agree with paths", "[photons][statistics][volumes]")
{
    const std::vector<GridScene> scenes = gridScenes();
    const double threshold = sidak(0.01, 3 * static_cast<int>(scenes.size()));
    for (const GridScene& scene : scenes)
    {
        const auto traced = scene.builder.build();
        const View view = cornellView(12, 12);
        RenderOptions options = optionsOf(IntegratorKind::Path, 12);
        const Estimate path = meanOf(traced, view, options, 32);
        for (const IntegratorKind kind :
             {IntegratorKind::Sppm, IntegratorKind::Ppm, IntegratorKind::PhotonCaustics})
        {
            options.integrator = kind;
            options.photons = 2000;
            options.photonRadius = 4.0f;
            CAPTURE(scene.name, int(kind));
            checkAgreement(path, meanOf(traced, view, options, 8), 0.06, threshold);
        }
    }
}

// The caustic of a ball is seen through smoke, and shines in it. Each comparison raises a false
// alarm in a thousand seeds.
TEST_CASE("photons in volumes: a caustic behind smoke and in it", "[photons][statistics][volumes]")
{
    const View view = perspectiveView({420, 95, 20}, {420, 0, 130}, {0, 1, 0}, 30.0, 12, 12);
    const auto traced = ballUnderSmoke().build();
    RenderOptions options = optionsOf(IntegratorKind::Path, 12);
    const Estimate path = meanOf(traced, view, options, 64);
    options.photons = 20000;
    options.photonRadius = 8.0f;
    for (const IntegratorKind kind : {IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
    {
        options.integrator = kind;
        CAPTURE(int(kind));
        checkAgreement(path, meanOf(traced, view, options, 4), 0.03, 0.001);
    }
}

// The closed form of VolumePhotonsTest.cpp for fog, with a volume in place of the fog.
TEST_CASE("photons in volumes: the image of a light in a mirror shines in smoke",
          "[photons][statistics][volumes]")
{
    SceneBuilder builder;
    builder.add(quadMesh({-30, -30, -1}, {60, 0, 0}, {0, 60, 0}), mirror(Vec3(1.0f)));
    builder.add(quadMesh({10, -0.01f, -0.01f}, {0, 0.02f, 0}, {0, 0, 0.02f}), lambert(Vec3(0.0f)));
    builder.addLight(pointLight({5, 0, 1}, Vec3(float(1.0 / 3.14159265358979))));
    builder.scene->volumes.push_back(
        densityIn({-30, -30, -1}, {30, 30, 30}, clumps(9), mediumOf(0.2f, kMirrorAlbedo)));
    makeEven(builder.scene->volumes.back(), Vec4(1.0f, 1.0f, 1.0f, 0.5f));
    const auto traced = builder.build();
    const double both = kOfLight + kOfImage;
    const Estimate paths = measure(traced, alongMirror(), optionsOf(IntegratorKind::Path, 2), 8);
    CHECK(paths.agrees(kOfLight, 0.005 * both)); // what photons are for
    for (const IntegratorKind kind : {IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
    {
        RenderOptions options = optionsOf(kind, 2);
        options.photons = 20000;
        options.photonRadius = 0.4f;
        const Estimate seen = measure(traced, alongMirror(), options, 16);
        CAPTURE(int(kind), both, kOfLight, seen.mean(), seen.standardError());
        CHECK(seen.agrees(both, 0.005 * both));
        CHECK(seen.standardError() < 0.02 * both);
    }
}

// The sphere of a look-up is four times as thick as the volume: what is within it must count as if
// the volume went on.
TEST_CASE("photons in volumes: a thin layer loses no light at its faces",
          "[photons][statistics][volumes]")
{
    constexpr float kHalf = 0.05f;
    SceneBuilder builder;
    builder.add(quadMesh({-30, -30, -1}, {60, 0, 0}, {0, 60, 0}), mirror(Vec3(1.0f)));
    builder.add(quadMesh({10, -0.01f, -0.01f}, {0, 0.02f, 0}, {0, 0, 0.02f}), lambert(Vec3(0.0f)));
    builder.addLight(pointLight({5, 0, 1}, Vec3(float(1.0 / 3.14159265358979))));
    builder.scene->volumes.push_back(
        densityIn({-5, -5, -kHalf}, {15, 5, kHalf}, clumps(9), mediumOf(0.2f, kMirrorAlbedo)));
    makeEven(builder.scene->volumes.back(), Vec4(1.0f, 1.0f, 1.0f, 0.5f));
    const auto traced = builder.build();
    // Single scattering of the light and of its image along the ray, midpoint rule.
    constexpr double kSigma = 0.1, kSteps = 20000;
    double both = 0.0;
    for (int i = 0; i < int(kSteps); ++i)
    {
        const double t = 10.0 * (i + 0.5) / kSteps;
        for (const double height : {1.0, 3.0})
        {
            const double d2 = (t - 5.0) * (t - 5.0) + height * height;
            const double within = std::sqrt(d2) * double(kHalf) / height;
            // The image lights the layer from below, through its lower half.
            both += double(kMirrorAlbedo) * kSigma / (4.0 * 3.14159265358979) *
                    std::exp(-kSigma * (t + within)) / d2 * 10.0 / kSteps;
        }
    }
    for (const IntegratorKind kind : {IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
    {
        RenderOptions options = optionsOf(kind, 2);
        options.photons = 20000;
        options.photonRadius = 0.2f;
        const Estimate seen = measure(traced, alongMirror(), options, 16);
        CAPTURE(int(kind), both, seen.mean(), seen.standardError());
        CHECK(seen.agrees(both, 0.002 * both)); // the kernel's blur is 0.1 % of the image's light
        CHECK(seen.standardError() < 0.02 * both);
    }
}

// All light that photons do not bring, or bring twice, is missed or seen.
TEST_CASE("photons in volumes: what does not absorb is not seen in a white sky",
          "[photons][statistics][volumes]")
{
    SceneBuilder builder;
    addSky(builder);
    builder.add(sphereMesh({0, 0, 1.2f}, 0.5f, 32), glass(1.5f));
    builder.add(sphereMesh({0, 1.1f, 0.2f}, 0.4f, 32), mirror(Vec3(1.0f)));
    builder.add(boxMesh({-0.6f, -1.2f, -0.6f}, {0.6f, -0.4f, 0.4f}), lambert(Vec3(1.0f)));
    builder.scene->volumes.push_back(
        densityIn({-1, -1.5f, -0.8f}, {1, 1.5f, 0.6f}, clumps(12), mediumOf(3.0f, 1.0f, 0.3f)));
    builder.scene->volumes.push_back(
        densityIn({-0.8f, 0, -0.8f}, {0.8f, 1.4f, 2}, clumps(12), mediumOf(2.0f, 1.0f, -0.4f)));
    const auto traced = builder.build();
    const View view = perspectiveView({6, 0, 1}, {0, 0, 0.4}, {0, 0, 1}, 26.0, 16, 16);
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Sppm,
                                      IntegratorKind::Ppm, IntegratorKind::PhotonCaustics})
    {
        RenderOptions options = optionsOf(kind, 24);
        options.photons = 5000;
        options.photonRadius = 0.04f;
        const Estimate seen = meanOf(traced, view, options, 4);
        CAPTURE(int(kind), seen.mean(), seen.standardError());
        CHECK(seen.agrees(1.0, 0.006)); // edges of discs, and what glass keeps for too long
        CHECK(seen.standardError() < 0.01);
    }
}

TEST_CASE("photons in volumes: the same bits for any number of threads", "[photons][volumes]")
{
    for (const GridScene& scene : gridScenes())
        for (const IntegratorKind kind : {IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
        {
            const auto traced = scene.builder.build();
            RenderOptions options = optionsOf(kind, 8);
            options.photons = 12000;
            const View view = cornellView(24, 24);
            CAPTURE(scene.name, int(kind));
            const Picture one = render(traced, view, options, 2, 1);
            CHECK(one.rgba == render(traced, view, options, 2, 2).rgba);
            CHECK(one.rgba == render(traced, view, options, 2, 16).rgba);
        }
}
