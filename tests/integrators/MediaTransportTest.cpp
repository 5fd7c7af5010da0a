// MediaTransportTest.cpp - slabs, energy, nesting and limits of paths through media.
// SPDX-License-Identifier: MIT
#include "tests/integrators/MediaScenes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Adds a wall that shines with radiance 1 towards -x.
void addShiningWall(SceneBuilder& builder, float x)
{
    builder.add(quadMesh({x, -9, -9}, {0, 0, 18}, {0, 18, 0}), lamp(Vec3(1.0f)));
}

} // namespace

TEST_CASE("media: reflectance and transmittance of slabs", "[integrators][statistics][media][long]")
{
    // Adding-doubling at a cosine of 0.5; four digits are safe.
    const struct
    {
        float depth, albedo, g;
        double reflected, transmitted;
    } cases[] = {{1, 0.5f, 0, 0.1498, 0.2303},
                 {1, 0.9f, 0, 0.3937, 0.4148},
                 {1, 1.0f, 0, 0.4984, 0.5016},
                 {10, 0.9f, 0, 0.5079, 0.0030},
                 {2, 0.9f, 0.75f, 0.2336, 0.4159}};
    for (const auto& c : cases)
        for (const bool above : {true, false})
        {
            SceneBuilder builder;
            builder.add(boxMesh({-400, -400, -1}, {400, 400, 0}),
                        bodyOf(mediumOf(c.depth, c.albedo, c.g)));
            addHalfSky(builder, above);
            const double sine = std::sqrt(0.75);
            const View view = perspectiveView({sine, 0, 0.5}, {0, 0, 0}, {0, 1, 0}, 1e-3, 16, 16);
            const Estimate seen =
                measure(builder.build(), view, optionsOf(IntegratorKind::Path, 64), 8);
            CAPTURE(c.depth, c.albedo, c.g, above, seen.mean(), seen.standardError());
            CHECK(seen.agrees(above ? c.reflected : c.transmitted, 2e-4));
        }
}

TEST_CASE("media: bodies that overlap, from outside and from within", "[integrators][media]")
{
    for (const bool swapped : {false, true})
        for (const int priority : {1, -1})
            for (const double from : {-2.0, 0.5, 1.5})
            {
                Medium a = mediumOf(0.5f, 0.0f), b = mediumOf(0.2f, 0.0f);
                b.priority = priority;
                SceneBuilder builder;
                const auto addA = [&] { builder.add(boxMesh({0, -3, -3}, {2, 3, 3}), bodyOf(a)); };
                const auto addB = [&] { builder.add(boxMesh({1, -2, -2}, {3, 2, 2}), bodyOf(b)); };
                swapped ? addB() : addA();
                swapped ? addA() : addB();
                addShiningWall(builder, 5);
                const double inA = std::max(0.0, 1.0 - std::max(from, 0.0));
                const double inBoth = 2.0 - std::max(from, 1.0);
                const double depth = 0.5 * inA + (priority > 0 ? 0.2 : 0.5) * inBoth + 0.2 * 1.0;
                const Vec3 seen =
                    render(builder.build(), alongX(from), optionsOf(IntegratorKind::Path), 1)
                        .mean();
                CAPTURE(swapped, priority, from);
                CHECK(seen.y == Approx(std::exp(-depth)).epsilon(1e-4));
            }
}

TEST_CASE("media: of bodies with priorities the ratio of indices bends light",
          "[integrators][media]")
{
    // Straight through slabs, a share of (1 - F)^2 / (1 - F^2) passes two faces of reflectance F; a
    // glass that overlaps a drink of its own index has no face within.
    const auto fresnel = [](double ratio)
    { return (ratio - 1.0) * (ratio - 1.0) / ((ratio + 1.0) * (ratio + 1.0)); };
    for (const float drink : {1.5f, 1.33f})
    {
        Medium first, second = mediumOf(0.3f, 0.0f);
        first.priority = 1;
        SceneBuilder builder;
        builder.add(boxMesh({0, -90, -90}, {2, 90, 90}), bodyOf(first, 1.5f));
        builder.add(boxMesh({1.5f, -80, -80}, {3, 80, 80}), bodyOf(second, drink));
        addHalfSky(builder, true);
        addHalfSky(builder, false);
        builder.scene->lights.pop_back();
        Light& sky = builder.scene->lights.back();
        sky.environment.image = newEnvironment(16, 8, [](Vec3d d) { return Vec3(d.x > 0.0); });
        const Estimate seen =
            measure(builder.build(), alongX(-1.0), optionsOf(IntegratorKind::Path, 64), 64);
        // Three faces with what is absorbed between the last two, all orders of reflection.
        const double f1 = fresnel(1.5), f2 = fresnel(double(drink) / 1.5), f3 = fresnel(drink);
        const double a = std::exp(-0.3);
        const double t23 = (1 - f2) * (1 - f3) * a / (1 - f2 * f3 * a * a);
        const double r23 = f2 + (1 - f2) * (1 - f2) * f3 * a * a / (1 - f2 * f3 * a * a);
        const double passed = (1 - f1) * t23 / (1 - f1 * r23);
        CAPTURE(drink, passed, seen.mean(), seen.standardError());
        CHECK(seen.agrees(passed, 1e-4));
    }
}

TEST_CASE("media: exponential fog as a medium is the fog of OpenGL", "[integrators][media]")
{
    for (const FogUse use : {FogUse::Depth, FogUse::Medium, FogUse::Off})
    {
        SceneBuilder builder;
        Material wall = lamp(Vec3(1.0f));
        wall.fog.mode = FogMode::Exponential;
        wall.fog.density = 0.05f;
        wall.fog.radial = true;
        builder.add(quadMesh({10, -9, -9}, {0, 0, 18}, {0, 18, 0}), wall);
        builder.scene->fogUse = use;
        for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
        {
            const Vec3 seen = render(builder.build(), alongX(0.0), optionsOf(kind), 1).mean();
            CAPTURE(int(use), int(kind));
            CHECK(seen.y == Approx(use == FogUse::Off ? 1.0 : 0.606531).epsilon(1e-5));
        }
    }
}

TEST_CASE("media: Whitted's integrator has single scattering and dims lights",
          "[integrators][statistics][media]")
{
    SceneBuilder builder;
    setAtmosphere(builder, mediumOf(0.1f, 0.8f, 0.4f), 90.0f);
    builder.add(boxMesh({3, -1, -1}, {4, 1, 1}), bodyOf(mediumOf(0.7f, 0.9f)));
    builder.add(quadMesh({6, -9, -9}, {0, 0, 18}, {0, 18, 0}), lambert(Vec3(0.7f)));
    builder.addLight(pointLight({2, 1, 0}, Vec3(3.0f)));
    builder.addQuadLight({1, -3, 4}, {0, 2, 0}, {2, 0, 0}, Vec3(2.0f));
    const auto traced = builder.build();
    const View view = perspectiveView({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 30.0, 16, 16);
    const Estimate paths = measure(traced, view, optionsOf(IntegratorKind::Path, 1), 64);
    const Estimate whitted = measure(traced, view, optionsOf(IntegratorKind::Whitted), 16);
    CAPTURE(paths.mean(), paths.standardError(), whitted.mean(), whitted.standardError());
    const double spread = std::hypot(paths.standardError(), whitted.standardError());
    CHECK(std::abs(paths.mean() - whitted.mean()) < 4.0 * spread);
    CHECK(spread < 0.01 * paths.mean());
    const Picture picture = render(traced, view, optionsOf(IntegratorKind::Whitted), 1);
    CHECK(picture.progress.mediumNote == MediumNote::SingleOnly);
}

TEST_CASE("media: the choice of the integrator, and the same bits for any number of threads",
          "[integrators][media]")
{
    SceneBuilder builder = cornellBox();
    const Vec3 middle(278, 273, 280);
    setAtmosphere(builder, mediumOf(1.0f / 500.0f, 0.9f, 0.3f), 800.0f, middle);
    builder.add(sphereMesh({400, 150, 120}, 70.0f, 24), bodyOf(mediumOf(0.05f, 0.95f), 1.4f));
    const auto traced = builder.build();
    const View view = cornellView(48, 48);
    const Picture one = render(traced, view, optionsOf(IntegratorKind::Path), 2, 1);
    const Picture two = render(traced, view, optionsOf(IntegratorKind::Path), 2, 2);
    CHECK(one.rgba == two.rgba);
    CHECK(one.progress.collisions > 0);
    CHECK(one.progress.mediumNote == MediumNote::None);
    const Picture photons = render(traced, view, optionsOf(IntegratorKind::PhotonCaustics), 2, 1);
    CHECK(photons.progress.integrator == IntegratorKind::PhotonCaustics);
    CHECK(photons.progress.mediumNote == MediumNote::None);
    CHECK(photons.progress.storedBeams > 0);
    CHECK(render(traced, view, optionsOf(IntegratorKind::Automatic), 1).progress.integrator ==
          IntegratorKind::PhotonCaustics);

    SceneBuilder glowing = cornellBox();
    Medium medium = mediumOf(1.0f / 500.0f, 0.9f);
    medium.emission = Vec3(1e-3f);
    setAtmosphere(glowing, medium, 800.0f, middle);
    const auto lit = glowing.build();
    CHECK(render(lit, view, optionsOf(IntegratorKind::Automatic), 1).progress.integrator ==
          IntegratorKind::Path);
    const Picture paths = render(lit, view, optionsOf(IntegratorKind::Sppm), 1);
    CHECK(paths.progress.integrator == IntegratorKind::Path);
    CHECK(paths.progress.mediumNote == MediumNote::PathsInstead);
}

TEST_CASE("media: walks that do not end are cut and counted", "[integrators][media]")
{
    SceneBuilder builder;
    builder.add(sphereMesh(Vec3(0.0f), 1.0f, 24), bodyOf(mediumOf(1e4f, 1.0f)));
    addHalfSky(builder, true);
    const Picture picture = render(builder.build(), patchView({0, 0, 2}, {0, 0, 1}, 0.5, 16),
                                   optionsOf(IntegratorKind::Path, 8), 1);
    // H(1) / sqrt(pi n) = 1.6 % of all paths are left after n collisions [Chandrasekhar60].
    CHECK(picture.progress.cutWalks > 0);
    CHECK(picture.progress.cutWalks < 20);
    CHECK(picture.progress.droppedSamples == 0);
}
