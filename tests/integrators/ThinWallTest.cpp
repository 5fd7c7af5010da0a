// ThinWallTest.cpp - light passes panes straight. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/integrators/MaterialDetails.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("panes: in a white room they cannot be seen, and no light counts twice",
          "[integrators][statistics]")
{
    MaterialDetail thin;
    thin.thinWalled = true;
    for (const bool sampled : {false, true})
    {
        SceneBuilder builder;
        const auto room = boxMesh(Vec3(-3.0f), Vec3(3.0f));
        if (sampled)
            builder.addEmissive(room, lamp(Vec3(1.0f)));
        else
            builder.add(room, lamp(Vec3(1.0f)));
        builder.add(quadMesh({-2, -2, 0.5f}, {4, 0, 0}, {0, 4, 0}), withDetail(glass(1.5f), thin));
        Material white = lambert(Vec3(1.0f));
        builder.add(quadMesh({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), white);
        const View view = perspectiveView({0.3, -1.0, 2.0}, {0, 0, 0}, {0, 1, 0}, 20.0, 16, 16);
        const Estimate radiance =
            measure(builder.build(), view, optionsOf(IntegratorKind::Path, 60), 64);
        CAPTURE(sampled, radiance.mean(), radiance.standardError());
        CHECK(radiance.agrees(1.0, 1e-3));
        CHECK(radiance.standardError() < 0.01);
    }
}

TEST_CASE(
    "panes: light of lamps without area passes any number of them straight, each tinted by 1 - F",
    "[integrators]")
{
    MaterialDetail thin;
    thin.thinWalled = true;
    Material green = glass(1.5f);
    green.baseColor = Vec3(0.25f, 1.0f, 0.5f);
    const auto lit = [&](int panes, IntegratorKind kind, bool classic)
    {
        SceneBuilder builder;
        Material floor = lambert(Vec3(0.5f));
        if (classic)
        {
            floor = Material();
            floor.diffuse = Vec3(0.5f);
            floor.ambient = Vec3(0.0f);
        }
        builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), floor);
        for (int i = 0; i < panes; ++i)
            builder.add(quadMesh({-9, -9, 1 + 0.1f * float(i)}, {18, 0, 0}, {0, 18, 0}),
                        withDetail(green, thin));
        Light light = slanted(0.0f);
        builder.addLight(light);
        const View view = perspectiveView({0.0, -0.5, 0.5}, {0, 0, 0}, {0, 0, 1}, 5.0, 4, 4);
        return render(builder.build(), view, optionsOf(kind, 1), 1).mean();
    };
    const double passed = (1.0 - 0.04) / (1.0 + 0.04);
    for (const IntegratorKind kind : kKinds)
        for (const bool classic : {false, true})
            for (const int panes : {1, 2, 4, 5, 7})
            {
                const Vec3 open = lit(0, kind, classic), behind = lit(panes, kind, classic);
                CAPTURE(int(kind), classic, panes);
                REQUIRE(open.y > 0.1f);
                CHECK(behind.y == Approx(open.y * std::pow(passed, panes)).epsilon(1e-4));
                CHECK(behind.x == Approx(open.x * std::pow(passed * 0.25, panes)).epsilon(1e-4));
                CHECK(behind.z == Approx(open.z * std::pow(passed * 0.5, panes)).epsilon(1e-4));
            }
}

TEST_CASE("panes: photons and paths find the same light behind them",
          "[integrators][statistics][long]")
{
    MaterialDetail thin;
    thin.thinWalled = true;
    SceneBuilder builder;
    builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(0.7f)));
    builder.add(quadMesh({-1, -1, 0}, {0, 2, 0}, {0, 0, 2}), lambert(Vec3(0.7f)));
    builder.add(quadMesh({-1.5f, -1.5f, 1}, {3, 0, 0}, {0, 3, 0}), withDetail(glass(1.5f), thin));
    builder.addQuadLight({-0.3f, 0.3f, 1.9f}, {0.6f, 0, 0}, {0, -0.6f, 0}, Vec3(5.0f));
    const auto scene = builder.build();
    const View view = perspectiveView({0.9, -0.9, 0.8}, {-0.5, 0.2, 0.2}, {0, 0, 1}, 40.0, 24, 24);
    const Estimate paths = measure(scene, view, optionsOf(IntegratorKind::Path), 64);
    CHECK(paths.mean() > 0.05);
    for (const IntegratorKind kind : {IntegratorKind::PhotonCaustics, IntegratorKind::Sppm})
    {
        RenderOptions options = optionsOf(kind);
        options.photons = 20000;
        const Estimate photons = measure(scene, view, options, 16);
        CAPTURE(int(kind), paths.mean(), photons.mean());
        const double spread = 4.0 * std::hypot(paths.standardError(), photons.standardError());
        CHECK(std::abs(paths.mean() - photons.mean()) < spread + 0.02 * paths.mean());
    }
}
