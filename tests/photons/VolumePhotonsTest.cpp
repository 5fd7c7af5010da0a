// VolumePhotonsTest.cpp - photons in participating media bring the light that paths find there.
// SPDX-License-Identifier: MIT
#include "tests/PValues.h"
#include "tests/photons/BeamScenes.h"
#include "tests/photons/PhotonMeans.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

struct VolumeScene
{
    const char* name;
    SceneBuilder builder;
};

std::vector<VolumeScene> volumeScenes()
{
    std::vector<VolumeScene> scenes;
    scenes.push_back({"glass and mirror in coloured fog", foggyBox(0.6f, Vec3(0.9f, 0.6f, 0.3f))});
    SceneBuilder& balls = scenes.back().builder;
    balls.add(sphereMesh({400, 250, 120}, 90.0f, 24), glass(1.5f));
    balls.add(sphereMesh({150, 430, 300}, 90.0f, 24), mirror(Vec3(0.9f)));

    scenes.push_back({"bodies", cornellBox()});
    SceneBuilder& bodies = scenes.back().builder;
    bodies.add(sphereMesh({400, 250, 120}, 90.0f, 24), bodyOf(mediumOf(0.02f, 0.95f), 1.4f));
    bodies.add(boxMesh({60, 330, 200}, {250, 500, 400}), bodyOf(mediumOf(0.01f, 0.9f, 0.5f)));

    scenes.push_back({"dense bodies", cornellBox()}); // photons are points there
    SceneBuilder& dense = scenes.back().builder;
    dense.add(sphereMesh({400, 250, 120}, 90.0f, 24), bodyOf(mediumOf(0.4f, 0.95f), 1.4f));
    dense.add(boxMesh({60, 330, 200}, {250, 500, 400}), bodyOf(mediumOf(0.5f, 0.9f, 0.5f)));

    // Photons are points in the ball, and beams in the box.
    scenes.push_back({"droplets", cornellBox()});
    SceneBuilder& droplets = scenes.back().builder;
    Medium cloud = mediumOf(0.4f, 0.95f), mist = mediumOf(0.01f, 0.9f);
    cloud.dropletSize = mist.dropletSize = 5.0f;
    droplets.add(sphereMesh({400, 250, 120}, 90.0f, 24), bodyOf(cloud, 1.4f));
    droplets.add(boxMesh({60, 330, 200}, {250, 500, 400}), bodyOf(mist));

    // The fog lies on the floor: photons are beams in it, or points.
    scenes.push_back({"a layer of fog", foggyBox(0.6f, Vec3(0.9f, 0.6f, 0.3f))});
    SceneBuilder& layer = scenes.back().builder;
    setAtmosphere(layer, mediumOf(0.01f, 0.9f, 0.4f), 700.0f, {278, 60, 280});
    thinOut(layer, 90.0f, {0, 1, 0});
    layer.add(sphereMesh({400, 250, 120}, 90.0f, 24), glass(1.5f));
    scenes.push_back({"a dense layer", cornellBox()});
    SceneBuilder& thick = scenes.back().builder;
    setAtmosphere(thick, mediumOf(0.6f, 0.9f), 700.0f, {278, 0, 280});
    thinOut(thick, 60.0f, {0, 1, 0});
    return scenes;
}

} // namespace

// All comparisons together raise a false alarm with a probability of 1 %.
TEST_CASE("volume photons: agree with paths", "[photons][statistics][media]")
{
    const std::vector<VolumeScene> scenes = volumeScenes();
    const double threshold = sidak(0.01, 3 * static_cast<int>(scenes.size()));
    for (const VolumeScene& scene : scenes)
    {
        const auto traced = scene.builder.build();
        const View view = cornellView(12, 12);
        RenderOptions options = optionsOf(IntegratorKind::Path, 12);
        const Estimate path = meanOf(traced, view, options, 48);
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

TEST_CASE("volume photons: what has come through smoke meets the smoke behind it",
          "[photons][statistics][media]")
{
    SceneBuilder builder = cornellBox();
    builder.add(boxMesh({5, 400, 5}, {545, 500, 550}), bodyOf(mediumOf(0.01f, 0.1f)));
    builder.add(boxMesh({5, 150, 5}, {545, 250, 550}), bodyOf(mediumOf(0.01f, 0.1f)));
    const auto traced = builder.build();
    // The floor below both, far from all edges, so that discs lose nothing.
    const View view = perspectiveView({420, 70, 20}, {420, 0, 130}, {0, 1, 0}, 5.0, 16, 16);
    RenderOptions options = optionsOf(IntegratorKind::Path, 12);
    const Estimate path = meanOf(traced, view, options, 64);
    options.integrator = IntegratorKind::Sppm;
    options.photons = 50000;
    options.photonRadius = 15.0f;
    checkAgreement(path, meanOf(traced, view, options, 8), 0.02, 0.001);
}

TEST_CASE("volume photons: the image of a light in a mirror shines in fog",
          "[photons][statistics][media]")
{
    const auto traced = mirrorInFog().build();
    const double both = kOfLight + kOfImage;
    const Estimate paths = measure(traced, alongMirror(), optionsOf(IntegratorKind::Path, 2), 8);
    CHECK(paths.agrees(kOfLight, 0.002 * both)); // what photons are for
    for (const IntegratorKind kind : {IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
    {
        RenderOptions options = optionsOf(kind, 2);
        options.photons = 20000;
        options.photonRadius = 0.2f;
        const Estimate seen = measure(traced, alongMirror(), options, 16);
        CAPTURE(int(kind), both, seen.mean(), seen.standardError());
        CHECK(seen.agrees(both, 0.003 * both));
        CHECK(seen.standardError() < 0.02 * both);
    }
}

TEST_CASE("volume photons: the image of a light in a mirror shines in droplets",
          "[photons][statistics][media]")
{
    SceneBuilder builder = mirrorInFog();
    Atmosphere fog = *builder.scene->atmosphere;
    fog.medium.dropletSize = 8.0f;
    builder.scene->atmosphere = std::make_shared<Atmosphere>(fog);
    const Phase phase = dropletPhase(8.0f);
    const auto airLight = [&phase](double across) // as for kOfLight and kOfImage
    {
        double sum = 0.0;
        for (int i = 0; i < 10000; ++i)
        {
            const double t = (i + 0.5) * 1e-3, d = std::hypot(t - 5.0, across);
            const double p = double(evalPhase(phase, static_cast<float>((5.0 - t) / d)));
            sum += 1e-3 * 0.1 * double(kMirrorAlbedo) * p * std::exp(-0.1 * (t + d)) / (d * d);
        }
        return sum;
    };
    const double ofLight = airLight(1.0), both = ofLight + airLight(3.0);
    const auto traced = builder.build();
    const Estimate paths = measure(traced, alongMirror(), optionsOf(IntegratorKind::Path, 2), 32);
    CAPTURE(ofLight, both, paths.mean(), paths.standardError());
    CHECK(paths.agrees(ofLight, 0.002 * both));
    CHECK(paths.standardError() < 0.02 * both);
    for (const IntegratorKind kind : {IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
    {
        RenderOptions options = optionsOf(kind, 2);
        options.photons = 20000;
        options.photonRadius = 0.2f;
        const Estimate seen = measure(traced, alongMirror(), options, 16);
        CAPTURE(int(kind), both, seen.mean(), seen.standardError());
        CHECK(seen.agrees(both, 0.003 * both));
        CHECK(seen.standardError() < 0.02 * both);
    }
}

TEST_CASE("volume photons: the same bits for any number of threads", "[photons][media]")
{
    for (const VolumeScene& scene : volumeScenes())
        for (const IntegratorKind kind : {IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
        {
            const auto traced = scene.builder.build();
            RenderOptions options = optionsOf(kind, 8);
            options.photons = 4000;
            const View view = cornellView(24, 24);
            CAPTURE(scene.name, int(kind));
            const Picture one = render(traced, view, options, 2, 1);
            CHECK(one.rgba == render(traced, view, options, 2, 2).rgba);
            CHECK(one.rgba == render(traced, view, options, 2, 16).rgba);
        }
}
