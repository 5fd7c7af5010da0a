// SubsurfacePhotonsTest.cpp - photons that walk below diffuse boundaries, threads, and Whitted's
// look.
// SPDX-License-Identifier: MIT
//
// All tests have fixed seeds. Means have to agree within four standard errors, as Estimate says.
#include "tests/integrators/MaterialDetails.h"
#include "tests/integrators/SubsurfaceScenes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("subsurface: photons bring what paths find", "[statistics][subsurface][long]")
{
    // In the way of the lamp stands a mirror, so that there are caustics.
    const auto scene = [](float weight)
    {
        SceneBuilder builder =
            room(wax(Vec3(0.9f, 0.7f, 0.5f), Vec3(0.6f, 0.4f, 0.2f), 1.4f, weight));
        builder.add(quadMesh({-2.5f, -1.0f, 0.0f}, {0.0f, 2.0f, 0.0f}, {-0.8f, 0.0f, 2.0f}),
                    mirror(Vec3(0.9f)));
        return builder.build();
    };
    for (const float weight : {1.0f, 0.5f})
    {
        const auto traced = scene(weight);
        RenderOptions options = optionsOf(IntegratorKind::Path, 5);
        const Estimate expected = measure(traced, roomView(), options, 4);
        options.photons = 20000;
        for (const IntegratorKind kind :
             {IntegratorKind::PhotonCaustics, IntegratorKind::Ppm, IntegratorKind::Sppm})
        {
            options.integrator = kind;
            const Estimate seen = measure(traced, roomView(), options, 4);
            CAPTURE(weight, int(kind), seen.mean(), seen.standardError(), expected.mean(),
                    expected.standardError());
            // The kernel blurs light beyond edges: 1 % beside the noise.
            CHECK(seen.agrees(expected.mean(),
                              4.0 * expected.standardError() + 0.01 * expected.mean()));
        }
    }
}

TEST_CASE("subsurface: photons bring the light that comes through a wall of wax",
          "[statistics][subsurface][long]")
{
    // The lamp is behind the wall, which is wide, and the eye sees the floor before it.
    SceneBuilder builder;
    builder.add(boxMesh(Vec3(-6.0f, 0.0f, -0.5f), Vec3(6.0f, 0.3f, 8.0f)),
                wax(Vec3(0.9f, 0.8f, 0.7f), Vec3(0.2f, 0.15f, 0.1f), 1.4f));
    builder.add(quadMesh({-6.0f, -6.0f, 0.0f}, {12.0f, 0.0f, 0.0f}, {0.0f, 6.0f, 0.0f}),
                lambert(Vec3(0.6f)));
    builder.addQuadLight({-0.5f, 1.0f, 0.5f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, Vec3(30.0f));
    const auto traced = builder.build();
    const View view = patchView({0.0f, -1.0f, 0.0f}, {0, 0, 1}, 0.8, 16);
    RenderOptions options = optionsOf(IntegratorKind::Path, 5);
    const Estimate expected = measure(traced, view, options, 40);
    options.photons = 10000;
    for (const IntegratorKind kind : {IntegratorKind::Ppm, IntegratorKind::Sppm})
    {
        options.integrator = kind;
        const Estimate seen = measure(traced, view, options, 6);
        CAPTURE(int(kind), seen.mean(), seen.standardError(), expected.mean(),
                expected.standardError());
        CHECK(expected.standardError() < 0.01 * expected.mean());
        CHECK(seen.agrees(expected.mean(), 4.0 * expected.standardError()));
    }
}

TEST_CASE("subsurface: photons are mirrored by brushed wax as paths are",
          "[statistics][subsurface][long]")
{
    // Brushes that are slanted to the sheet's edges throw the lamp's light to one side of the wall.
    Material brushed = wax(Vec3(0.9f), Vec3(0.05f), 1.5f);
    brushed.metallic = 0.9f;
    brushed.roughness = 0.3f;
    brushed =
        changed(brushed, [](Material&, MaterialDetail& detail) { detail.anisotropy = 0.95f; });
    SceneBuilder builder;
    builder.add(mappedQuad({0.7f, 0.7f}, {-0.7f, 0.7f}), brushed);
    builder.add(quadMesh({-6.0f, 2.0f, 0.0f}, {12.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 6.0f}),
                lambert(Vec3(0.8f)));
    builder.addQuadLight({-0.2f, -2.2f, 1.5f}, {0.0f, 0.3f, 0.3f}, {0.4f, 0.0f, 0.0f}, Vec3(30.0f));
    const auto traced = builder.build();
    RenderOptions options = optionsOf(IntegratorKind::Path, 3);
    options.photons = 20000;
    for (const float x : {-1.5f, 1.5f})
    {
        const View view = patchView({x, 2.0f, 1.0f}, {0, -1, 0}, 0.6, 8);
        options.integrator = IntegratorKind::Path;
        const Estimate expected = measure(traced, view, options, 64);
        options.integrator = IntegratorKind::Sppm;
        const Estimate seen = measure(traced, view, options, 16);
        CAPTURE(x, seen.mean(), seen.standardError(), expected.mean(), expected.standardError());
        CHECK(expected.standardError() < 0.02 * expected.mean());
        CHECK(seen.standardError() < 0.02 * expected.mean());
        CHECK(seen.agrees(expected.mean(), 4.0 * expected.standardError()));
    }
}

TEST_CASE("subsurface: pictures do not depend on the number of threads", "[subsurface]")
{
    SceneBuilder builder = room(wax(Vec3(0.9f, 0.7f, 0.5f), Vec3(0.4f, 0.2f, 0.1f), 1.5f));
    const RenderOptions options = optionsOf(IntegratorKind::Path, 5);
    const Picture one = render(builder.build(1), roomView(), options, 2, 1);
    CHECK(one.progress.collisions > 0);
    for (const int threads : {2, 16})
        CHECK(render(builder.build(threads), roomView(), options, 2, threads).rgba == one.rgba);
}

TEST_CASE("subsurface: whitted shows the diffuse base and says so", "[subsurface]")
{
    const auto traced = room(wax(Vec3(0.5f), Vec3(0.1f))).build();
    const RenderOptions options = optionsOf(IntegratorKind::Whitted, 3);
    const Picture picture = render(traced, roomView(), options, 1);
    CHECK(picture.progress.mediumNote == MediumNote::DiffuseOnly);
    const auto plain = room(wax(Vec3(0.5f), Vec3(0.1f), 1.0f, 0.0f)).build();
    const Picture same = render(plain, roomView(), options, 1);
    CHECK(same.progress.mediumNote == MediumNote::None);
    CHECK(double(picture.mean().y) == Approx(double(same.mean().y)).epsilon(1e-4));
    const RenderOptions paths = optionsOf(IntegratorKind::Path, 3);
    CHECK(render(traced, roomView(), paths, 1).progress.mediumNote == MediumNote::None);
}
