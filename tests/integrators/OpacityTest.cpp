// OpacityTest.cpp - a pane of opacity a leaves 1 - a of the light of camera, mirror, shadow and
// photon rays.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr float kAlpha = 0.4f;
constexpr int kPixels = 16;

/// Returns a black material, so that light that the pane stops is lost.
Material paneMaterial()
{
    Material material = lambert(Vec3(0.0f));
    material.alpha = kAlpha;
    material.blended = true;
    return material;
}

/// Returns the mean of the picture over eight seeds.
Estimate meanOf(const SceneBuilder& builder, const View& view, IntegratorKind kind, int passes,
                int maxBounces = 8)
{
    const auto traced = builder.build();
    Estimate estimate;
    for (uint32_t seed = 0; seed < 8; ++seed)
    {
        RenderOptions options = optionsOf(kind, maxBounces, seed);
        options.photons = 20000;
        const Picture picture = render(traced, view, options, passes);
        REQUIRE(picture.progress.droppedSamples == 0);
        estimate.add(picture.mean().x);
    }
    return estimate;
}

/// Checks the share by 5 standard errors of eight values each. By Student's distribution a false
/// alarm has a probability of about 1e-3 in each case; with these fixed seeds there is none.
void checkShare(const Estimate& with, const Estimate& without)
{
    const double expected = (1.0 - kAlpha) * without.mean();
    const double error = std::hypot(with.standardError(), (1.0 - kAlpha) * without.standardError());
    CAPTURE(with.mean(), without.mean(), error);
    REQUIRE(without.mean() > 0.0);
    CHECK(error < 0.02 * expected);
    CHECK(std::abs(with.mean() - expected) < 5.0 * error + 1e-5 * expected);
}

} // namespace

TEST_CASE("opacity: camera rays, exact without noise with Whitted", "[integrators]")
{
    const View view = patchView({0, 0, 0}, {0, 0, 1}, 1.0, kPixels);
    SceneBuilder plate;
    plate.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lamp(Vec3(2.0f)));
    SceneBuilder behind = plate;
    behind.scene = std::make_shared<Scene>(*plate.scene);
    behind.add(quadMesh({-1, -1, 0.2f}, {2, 0, 0}, {0, 2, 0}), paneMaterial());
    behind.add(quadMesh({-1, -1, 0.3f}, {2, 0, 0}, {0, 2, 0}), paneMaterial());
    const Picture exact = render(behind.build(), view, optionsOf(IntegratorKind::Whitted), 1);
    for (int y = 0; y < kPixels; ++y)
        for (int x = 0; x < kPixels; ++x)
            REQUIRE(exact.at(x, y).x == Approx(2.0 * 0.36).epsilon(1e-5));

    SceneBuilder one = plate;
    one.scene = std::make_shared<Scene>(*plate.scene);
    one.add(quadMesh({-1, -1, 0.2f}, {2, 0, 0}, {0, 2, 0}), paneMaterial());
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Sppm})
        checkShare(meanOf(one, view, kind, 64), meanOf(plate, view, kind, 1));
}

TEST_CASE("opacity: where nothing is behind, coverage is the opacity", "[integrators]")
{
    const View view = patchView({0, 0, 0}, {0, 0, 1}, 1.0, kPixels);
    SceneBuilder builder;
    builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), paneMaterial());
    builder.scene->background = Vec4(9.0f); // camera rays never see it: it is composited later
    const Picture picture = render(builder.build(), view, optionsOf(IntegratorKind::Whitted), 1);
    CHECK(picture.rgba[0] == 0.0f);
    CHECK(picture.rgba[3] == Approx(kAlpha));
}

TEST_CASE("opacity: mirror, shadow and photon rays", "[integrators]")
{
    const auto kind =
        GENERATE(IntegratorKind::Whitted, IntegratorKind::Path, IntegratorKind::PhotonCaustics);
    CAPTURE(int(kind));
    SECTION("a mirror shows a plate behind a pane")
    {
        // The mirror fills the view; the pane is between the mirror and the plate, beside the
        // camera's rays.
        const View view = perspectiveView({0, -4, 4}, {0, 0, 0}, {0, 0, 1}, 4.0, kPixels, kPixels);
        const auto scene = [](bool pane)
        {
            SceneBuilder builder;
            builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), mirror(Vec3(1.0f)));
            builder.add(quadMesh({-3, 4, 1}, {6, 0, 0}, {0, 0, 6}), lamp(Vec3(1.0f)));
            if (pane) builder.add(quadMesh({-3, 2, 0.5f}, {6, 0, 0}, {0, 0, 6}), paneMaterial());
            return builder;
        };
        checkShare(meanOf(scene(true), view, kind, 64), meanOf(scene(false), view, kind, 4));
    }
    SECTION("a floor in the shadow of a pane")
    {
        const View view = patchView({0, 0, 0}, {0, 0, 1}, 0.5, kPixels);
        const auto scene = [](bool pane)
        {
            SceneBuilder builder;
            builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(0.5f)));
            builder.addLight(pointLight({4, 0, 4}));
            if (pane) builder.add(quadMesh({1.5f, -2, 0.5f}, {0, 4, 0}, {0, 0, 4}), paneMaterial());
            return builder;
        };
        checkShare(meanOf(scene(true), view, kind, 64), meanOf(scene(false), view, kind, 4));
    }
}

TEST_CASE("opacity: photons on their way to a mirror and from it", "[integrators]")
{
    // The light is shielded, the mirror is above and the floor below: the patch of the floor gets
    // all its light from the mirror.
    const auto kind = GENERATE(IntegratorKind::Sppm, IntegratorKind::PhotonCaustics);
    CAPTURE(int(kind));
    const View view = perspectiveView({0, -0.3, 1.2}, {0, 0, 0}, {0, 1, 0}, 30.0, kPixels, kPixels);
    const auto scene = [](bool pane)
    {
        SceneBuilder builder;
        builder.add(quadMesh({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), lambert(Vec3(0.5f)));
        builder.add(quadMesh({-2, 2, 3}, {4, 0, 0}, {0, -4, 0}), mirror(Vec3(1.0f)));
        builder.add(quadMesh({1.0f, -1, 0.9f}, {0, 2, 0}, {0.4f, 0, 0}), lambert(Vec3(0.0f)));
        builder.addLight(pointLight({1.2f, 0, 1}));
        if (pane) builder.add(quadMesh({-2, -2, 2}, {4, 0, 0}, {0, 4, 0}), paneMaterial());
        return builder;
    };
    // Photons pass the pane twice: on the way up and on the way down. Paths have three edges,
    // because light that the floor sends up to the mirror and gets back, one part in fifteen, would
    // pass the pane twice more.
    const Estimate with = meanOf(scene(true), view, kind, 24, 3),
                   without = meanOf(scene(false), view, kind, 12, 3);
    const double share = (1.0 - kAlpha) * (1.0 - kAlpha), expected = share * without.mean();
    const double error = std::hypot(with.standardError(), share * without.standardError());
    CAPTURE(with.mean(), expected, error);
    REQUIRE(without.mean() > 0.01);
    CHECK(error < 0.02 * expected);
    CHECK(std::abs(with.mean() - expected) < 5.0 * error);
}
