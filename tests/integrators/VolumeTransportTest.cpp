// VolumeTransportTest.cpp - paths through volumes compared with closed forms and with media.
// SPDX-License-Identifier: MIT
#include "tests/integrators/VolumeScenes.h"

#include <limits>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

View alongX(int pixels = 4)
{
    return perspectiveView({-1, 0.5, 0.5}, {0, 0.5, 0.5}, {0, 0, 1}, 1e-3, pixels, pixels);
}

/// Returns the mean of each channel over 16 seeds.
std::array<Estimate, 3> measureChannels(const std::shared_ptr<const TracedScene>& traced,
                                        const View& view, RenderOptions options, int passes)
{
    std::array<Estimate, 3> estimates;
    for (uint32_t seed = 0; seed < 16; ++seed)
    {
        options.seed = seed;
        const Picture picture = render(traced, view, options, passes);
        REQUIRE(picture.progress.status.ok());
        REQUIRE(picture.progress.droppedSamples == 0);
        for (int c = 0; c < 3; ++c)
            estimates[static_cast<std::size_t>(c)].add(double(picture.mean()[c]));
    }
    return estimates;
}

void addWall(SceneBuilder& builder, Vec3 radiance)
{
    builder.add(quadMesh({3, -50, -50}, {0, 0, 100}, {0, 100, 0}), lamp(radiance));
}

} // namespace

TEST_CASE("volumes: light falls by Beer's law through a ramp of densities",
          "[integrators][statistics][volumes]")
{
    // Colours differ by more than a factor of 8, and absorption and scattering are the same to
    // light that does not come back.
    const Vec3 sigma(0.4f, 1.5f, 4.0f);
    for (const int n : {1, 5, 40})
        for (const bool scatters : {false, true})
        {
            SceneBuilder builder;
            addWall(builder, Vec3(8.0f));
            Medium medium;
            (scatters ? medium.sigmaS : medium.sigmaA) = sigma;
            builder.scene->volumes.push_back(densityIn({0, 0, 0}, {1, 1, 1}, ramp(n), medium));
            const auto seen =
                measureChannels(builder.build(), alongX(), optionsOf(IntegratorKind::Path, 1), 16);
            for (std::size_t c = 0; c < 3; ++c)
            {
                const double expected = 8.0 * std::exp(-double(sigma[int(c)]) * rampDepth(n));
                CAPTURE(n, scatters, c, expected, seen[c].mean(), seen[c].standardError());
                CHECK(seen[c].agrees(expected, 1e-5));
            }
        }
}

TEST_CASE("volumes: no light is lost or gained in a white sky",
          "[integrators][statistics][volumes]")
{
    for (const bool sampled : {false, true})
    {
        SceneBuilder builder;
        Medium medium = mediumOf(6.0f, 1.0f, 0.4f);
        medium.sigmaS *= Vec3(0.5f, 1.0f, 2.0f);
        builder.scene->volumes.push_back(densityIn({0, 0, 0}, {1, 1, 1}, clumps(20), medium));
        builder.scene->volumes.push_back(
            densityIn({0.4f, 0.3f, -0.2f}, {1.5f, 0.8f, 0.6f}, clumps(11), mediumOf(2.0f, 1.0f)));
        setAtmosphere(builder, mediumOf(0.2f, 1.0f, -0.3f), 2.0f);
        Light sky;
        sky.kind = LightKind::Environment;
        sky.radiance = Vec3(1.0f);
        sky.environment.image = newEnvironment(8, 4, Vec3(1.0f));
        builder.addLight(sky);
        RenderOptions options = optionsOf(IntegratorKind::Path, 4);
        options.environmentSampling =
            sampled ? EnvironmentSampling::Uniform : EnvironmentSampling::Importance;
        const View view = perspectiveView({-3, 0.6, 0.5}, {0.6, 0.5, 0.4}, {0, 0, 1}, 30.0, 16, 16);
        const auto seen = measureChannels(builder.build(), view, options, 4);
        for (std::size_t c = 0; c < 3; ++c)
        {
            CAPTURE(sampled, c, seen[c].mean(), seen[c].standardError());
            CHECK(seen[c].agrees(1.0, 2e-4));
            CHECK(seen[c].standardError() < 0.01);
        }
    }
}

TEST_CASE("volumes: an even volume is a body of the same medium, in the light of all lights",
          "[integrators][statistics][volumes][long]")
{
    const Medium medium = mediumOf(2.0f, 0.8f, 0.3f);
    std::array<Estimate, 2> seen;
    for (const bool grid : {false, true})
    {
        SceneBuilder builder;
        builder.add(quadMesh({-2, -2, -0.5f}, {5, 0, 0}, {0, 5, 0}), lambert(Vec3(0.6f)));
        if (grid)
        {
            Volume volume = densityIn({0, 0, 0}, {1, 1, 1}, ramp(9), medium);
            makeEven(volume, Vec4(1.0f));
            builder.scene->volumes.push_back(volume);
        }
        else
            builder.add(boxMesh({0, 0, 0}, {1, 1, 1}), bodyOf(medium));
        builder.addLight(pointLight({0.5f, 2.0f, 1.5f}, Vec3(4.0f)));
        builder.addLight(pointLight({0.6f, 0.5f, 0.4f}, Vec3(0.2f)));
        builder.addQuadLight({-1, -1, 3}, {0, 2, 0}, {2, 0, 0}, Vec3(2.0f));
        Light sun;
        sun.kind = LightKind::Directional;
        sun.direction = glm::normalize(Vec3(0.3f, 0.4f, -1.0f));
        sun.diffuse = Vec3(0.3f);
        builder.addLight(sun);
        Light sky;
        sky.kind = LightKind::Environment;
        sky.radiance = Vec3(1.0f);
        sky.environment.image = sunnySky(16, 8);
        builder.addLight(sky);
        const View view = perspectiveView({-3, 0.6, 1.5}, {0.5, 0.5, 0.2}, {0, 0, 1}, 25.0, 24, 24);
        seen[grid] = measure(builder.build(), view, optionsOf(IntegratorKind::Path, 3), 16);
    }
    const double spread = std::hypot(seen[0].standardError(), seen[1].standardError());
    CAPTURE(seen[0].mean(), seen[1].mean(), spread);
    CHECK(std::abs(seen[0].mean() - seen[1].mean()) < 4.0 * spread);
    CHECK(spread < 0.01 * seen[0].mean());
}

TEST_CASE("volumes: what glows shows its colour by its optical depth",
          "[integrators][statistics][volumes]")
{
    // An opacity of 0.2 a cell: a ray along x takes -ln(0.8) 1.73 / |cell| in the unit cube.
    SceneBuilder builder;
    addWall(builder, Vec3(0.5f));
    Volume volume = densityIn({0, 0, 0}, {1, 1, 1}, ramp(6), {});
    volume.law = VolumeLaw::Cells;
    makeEven(volume, Vec4(0.9f, 0.6f, 0.2f, 0.2f));
    builder.scene->volumes.push_back(volume);
    const double cell = std::sqrt(1.0 / 36.0 + 2.0 / 9.0);
    const double left = std::pow(0.8, 1.73 / cell);
    const auto seen =
        measureChannels(builder.build(), alongX(), optionsOf(IntegratorKind::Path), 16);
    const Vec3d color(0.9, 0.6, 0.2);
    for (std::size_t c = 0; c < 3; ++c)
    {
        CAPTURE(c, left, seen[c].mean());
        CHECK(seen[c].agrees(color[int(c)] * (1.0 - left) + 0.5 * left, 1e-5));
        CHECK(seen[c].standardError() < 0.01);
    }
    // An opacity of 0.2 over a fifth of the width, and a colour in front of all.
    builder.scene->volumes[0].law = VolumeLaw::Samples;
    builder.scene->volumes[0].sampleLength = 0.2f;
    builder.scene->volumes[0].tint = Vec3(0.5f, 1.0f, 0.25f);
    const auto tinted =
        measureChannels(builder.build(), alongX(), optionsOf(IntegratorKind::Path), 16);
    for (std::size_t c = 0; c < 3; ++c)
    {
        const double shown = color[int(c)] * double(builder.scene->volumes[0].tint[int(c)]);
        CHECK(
            tinted[c].agrees(shown * (1.0 - std::pow(0.8, 5.0)) + 0.5 * std::pow(0.8, 5.0), 1e-5));
    }
    builder.scene->volumes[0] = volume;
    // Whitted's steps sum up the same colours, times the opacity as the shaders do.
    const Vec3 whitted =
        render(builder.build(), alongX(), optionsOf(IntegratorKind::Whitted), 1).mean();
    // Its samples stand at both ends of the way, one more than steps.
    const int count = 6;
    const double step = 1.0 / (count - 1);
    const double marched = std::pow(0.8, count * std::min(1.0, 1.73 * step / cell));
    for (int c = 0; c < 3; ++c)
        CHECK(double(whitted[c]) ==
              Approx(color[c] * (1.0 - marched) * (1.0 - marched) + 0.5 * marched).epsilon(1e-4));
}

TEST_CASE("volumes: what is lit by its gradient has the light of Whitted's steps",
          "[integrators][statistics][volumes]")
{
    // The tile is the middle of its image, whose values rise along x: the gradient is (1, 0, 0).
    SceneBuilder builder;
    Volume volume = densityIn({-0.25f, -0.25f, -0.25f}, {1.25f, 1.25f, 1.25f}, ramp(24), {});
    volume.tileFromEngine = cubeFromBox({0, 0, 0}, {1, 1, 1});
    makeEven(volume, Vec4(0.9f, 0.6f, 0.2f, 0.03f));
    volume.lit = true;
    volume.law = VolumeLaw::Samples;
    volume.sampleLength = 0.002f;
    builder.scene->volumes.push_back(volume);
    Light light;
    light.kind = LightKind::Directional;
    light.number = 0;
    for (const float angle : {0.0f, 1.0f, 2.5f}) // light that comes from below, and from above
    {
        light.direction = Vec3(std::cos(angle), std::sin(angle), 0.0f);
        light.diffuse = Vec3(0.3f); // osgVolume's shaders do not look at it
        builder.scene->lights = {light};
        const double scale = 0.1 + 0.9 * std::max(0.0f, std::cos(angle));
        const double length = 1.0 / 1.5 / 0.002; // samples on the way
        const double opacity = 1.0 - std::pow(0.97, length);
        const auto traced = builder.build();
        const auto seen = measureChannels(traced, alongX(), optionsOf(IntegratorKind::Path), 16);
        const Vec3 whitted = render(traced, alongX(), optionsOf(IntegratorKind::Whitted), 1).mean();
        const Vec3d color(0.9, 0.6, 0.2);
        for (std::size_t c = 0; c < 3; ++c)
        {
            CAPTURE(angle, c, seen[c].mean(), whitted[int(c)]);
            CHECK(seen[c].agrees(color[int(c)] * scale * opacity, 1e-4));
            CHECK(seen[c].agrees(double(whitted[int(c)]), 2e-3));
        }
    }
}

TEST_CASE("volumes: a lit ball looks the same by paths and by Whitted's steps",
          "[integrators][statistics][volumes]")
{
    SceneBuilder builder;
    const auto ball = newVolumeImage(16, 16, 16,
                                     [](int x, int y, int z)
                                     {
                                         const Vec3 p = Vec3(Vec3d(x, y, z)) - 7.5f;
                                         return std::max(0.0f, 1.0f - glm::length(p) / 7.0f);
                                     });
    Volume volume = densityIn({0, 0, 0}, {1, 1, 1}, ball, {});
    volume.law = VolumeLaw::Cells;
    volume.transfer = {Vec4(0.9f, 0.6f, 0.2f, 0.9f), Vec4(0.9f, 0.6f, 0.2f, 0.9f)};
    volume.transferScale = 0.0f;
    volume.transferOffset = 0.5f;
    volume.cutoff = 0.3f; // a ball with a border, nearly opaque within a few cells
    volume.sampleRatio = 4.0f;
    volume.lit = true;
    builder.scene->volumes.push_back(volume);
    for (const bool isFar : {true, false})
    {
        Light light;
        light.kind = isFar ? LightKind::Directional : LightKind::Point;
        light.number = 0;
        light.direction = glm::normalize(Vec3(1.0f, 0.5f, -0.7f));
        light.position = Vec3(4.0f, 3.0f, 1.0f);
        builder.scene->lights = {light};
        const auto traced = builder.build();
        const View view = perspectiveView({-3, 0.5, 0.5}, {0, 0.5, 0.5}, {0, 0, 1}, 16, 12, 12);
        const auto seen = measureChannels(traced, view, optionsOf(IntegratorKind::Path), 16);
        const Vec3 whitted = render(traced, view, optionsOf(IntegratorKind::Whitted), 64).mean();
        CAPTURE(isFar, seen[0].mean(), whitted.x, seen[0].standardError());
        CHECK(std::abs(seen[0].mean() - double(whitted.x)) < 0.03 * double(whitted.x));
        CHECK(seen[0].standardError() < 0.003 * seen[0].mean());
    }
}

TEST_CASE("volumes: emission of a density, with and without extinction",
          "[integrators][statistics][volumes]")
{
    for (const float sigma : {0.0f, 1.5f})
    {
        SceneBuilder builder;
        addWall(builder, Vec3(0.0f));
        Medium medium;
        medium.sigmaA = Vec3(sigma);
        medium.emission = Vec3(0.3f, 0.2f, 0.1f);
        Volume volume = densityIn({0, 0, 0}, {1, 1, 1}, ramp(6), medium);
        makeEven(volume, Vec4(1.0f));
        builder.scene->volumes.push_back(volume);
        const auto seen =
            measureChannels(builder.build(), alongX(), optionsOf(IntegratorKind::Path), 16);
        for (std::size_t c = 0; c < 3; ++c)
        {
            const double whole =
                sigma > 0.0f ? (1.0 - std::exp(-double(sigma))) / double(sigma) : 1.0;
            CAPTURE(sigma, c, seen[c].mean());
            CHECK(seen[c].agrees(double(medium.emission[int(c)]) * whole));
        }
    }
}

TEST_CASE("volumes: dense, empty and damaged ones are finite", "[integrators][volumes]")
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float scale : {0.0f, 1e-30f, 1e6f, 1e30f})
        for (const int kind : {0, 1, 2, 3})
        {
            SceneBuilder builder;
            addWall(builder, Vec3(1.0f));
            Volume volume =
                densityIn({0, 0, 0}, {1, 1, 1}, clumps(kind == 1 ? 1 : 9), mediumOf(scale, 0.5f));
            if (kind == 2) volume.law = VolumeLaw::Cells;
            if (kind == 3) volume.law = VolumeLaw::Samples;
            builder.scene->volumes.push_back(volume);
            volume.imageFromEngine.linear[1][1] = nan; // is left out
            builder.scene->volumes.push_back(volume);
            volume.imageFromEngine.linear = Mat3(0.0f);
            builder.scene->volumes.push_back(volume);
            for (const IntegratorKind integrator : {IntegratorKind::Path, IntegratorKind::Whitted})
            {
                const Picture picture =
                    render(builder.build(), alongX(8), optionsOf(integrator), 2);
                CAPTURE(scale, kind, int(integrator));
                CHECK(picture.progress.droppedSamples == 0);
                CHECK(picture.mean().y >= 0.0f);
                CHECK(picture.mean().y <= 4.5f); // the brightest voxel has 4
            }
        }
}

TEST_CASE("volumes: the same bits for any number of threads", "[integrators][volumes]")
{
    SceneBuilder builder = cornellBox();
    builder.scene->volumes.push_back(
        densityIn({100, 100, 100}, {400, 400, 400}, clumps(24), mediumOf(0.02f, 0.9f, 0.2f)));
    const auto traced = builder.build();
    const View view = cornellView(48, 48);
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
        CHECK(render(traced, view, optionsOf(kind), 2, 1).rgba ==
              render(traced, view, optionsOf(kind), 2, 2).rgba);
    CHECK(render(traced, view, optionsOf(IntegratorKind::Automatic), 1).progress.integrator ==
          IntegratorKind::Path);
}

TEST_CASE("volumes: photons fly through them, but do not bring their own light",
          "[integrators][volumes]")
{
    SceneBuilder builder = cornellBox();
    builder.scene->materials.back().transmission = 1.0f; // a caster of caustics
    builder.scene->volumes.push_back(
        densityIn({100, 100, 100}, {400, 400, 400}, clumps(24), mediumOf(0.02f, 0.9f, 0.2f)));
    const View view = cornellView(16, 16);
    const auto indirect = {IntegratorKind::Ppm, IntegratorKind::Sppm};
    const auto traced = builder.build();
    for (const IntegratorKind kind : indirect)
    {
        const Picture picture = render(traced, view, optionsOf(kind), 1);
        CHECK(picture.progress.integrator == kind);
        CHECK(picture.progress.mediumNote == MediumNote::None);
    }
    const Picture picture = render(traced, view, optionsOf(IntegratorKind::Automatic), 1);
    CHECK(picture.progress.integrator == IntegratorKind::PhotonCaustics);
    CHECK(picture.progress.mediumNote == MediumNote::None);

    builder.scene->volumes.back().medium.emission = Vec3(1e-3f);
    const auto glowing = builder.build();
    for (const IntegratorKind kind : indirect)
    {
        const Picture paths = render(glowing, view, optionsOf(kind), 1);
        CHECK(paths.progress.integrator == IntegratorKind::Path);
        CHECK(paths.progress.mediumNote == MediumNote::PathsInstead);
    }
    const Picture caustics = render(glowing, view, optionsOf(IntegratorKind::Automatic), 1);
    CHECK(caustics.progress.integrator == IntegratorKind::PhotonCaustics);
    CHECK(caustics.progress.mediumNote == MediumNote::None);
}

TEST_CASE("volumes: edits redo blocks alone, and those that serve are taken over",
          "[integrators][volumes]")
{
    SceneBuilder builder;
    addWall(builder, Vec3(1.0f));
    Volume volume = densityIn({0, 0, 0}, {1, 1, 1}, clumps(20), mediumOf(1.0f, 0.5f));
    builder.scene->volumes.push_back(volume);
    const auto workers = std::make_shared<Workers>(2);
    Stamp now = 1;
    builder.scene->changed = now;
    auto traced = TracedScene::build(builder.scene, workers);
    CHECK(traced->statistics().builtVolumes == 1);
    CHECK(traced->grids().builtValues() == 1);
    const auto edited = [&](const std::function<void(Volume&)>& edit)
    {
        const auto scene = std::make_shared<Scene>(traced->scene());
        edit(scene->volumes[0]);
        scene->volumes[0].changed = scene->changed = ++now;
        traced = TracedScene::build(scene, workers, traced);
        CHECK(traced->statistics().builtMeshes == 0);
        CHECK(traced->statistics().commits == 0);
        return std::pair(traced->grids().builtValues(), traced->grids().builtBlocks());
    };
    using Built = std::pair<std::size_t, std::size_t>;
    CHECK(edited([](Volume& v) { v.imageFromEngine.translation.x += 0.1f; }) == Built(0, 0));
    CHECK(edited([](Volume& v) { v.medium.sigmaS.x = 3.0f; }) == Built(0, 0));
    CHECK(edited([](Volume& v) { makeEven(v, Vec4(0.5f)); }) == Built(0, 1));
    CHECK(edited([](Volume& v) { v.transparency = 0.5f; }) == Built(0, 1));
    CHECK(edited([](Volume& v) { v.image = clumps(12); }) == Built(1, 1));
}
