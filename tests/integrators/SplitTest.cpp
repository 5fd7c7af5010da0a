// SplitTest.cpp - camera paths that split at their first clear interface.
// SPDX-License-Identifier: MIT
#include "tests/Environments.h"
#include "tests/integrators/Measure.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a sky of radiance above the horizon that is black below.
Light upperSky(Vec3 radiance)
{
    return environmentLight(
        newEnvironment(16, 8, [radiance](Vec3d d) { return d.z > 0.0 ? radiance : Vec3(0.0f); }));
}

/// Returns the reflectance of glass of index 1.5 at normal incidence.
constexpr double kReflectance = 0.2 * 0.2;

} // namespace

TEST_CASE("split paths: one pass has all of what glass mirrors", "[integrators]")
{
    // The glass mirrors a bright sky, and refracts to the dark. By chance one pixel in 25 would be
    // as bright as the sky, and the others black.
    SceneBuilder builder;
    builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), glass(1.5f));
    builder.addLight(upperSky(Vec3(100.0f)));
    const auto traced = builder.build();
    const View view = patchView({0, 0, 0}, {0, 0, 1}, 1e-2, 32);
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::PhotonCaustics})
    {
        const Picture picture = render(traced, view, optionsOf(kind, 4), 1);
        int wrong = 0;
        for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
            wrong += std::abs(picture.rgba[i] / (100.0 * kReflectance) - 1.0) > 1e-3;
        CAPTURE(int(kind));
        CHECK(wrong == 0);
    }
}

TEST_CASE("split paths: as many pixels split as there are, through a mirror, too", "[integrators]")
{
    // All 256 paths of each tile split, after a mirror has turned them by a right angle.
    SceneBuilder builder;
    builder.add(quadMesh({-1, 0, -1}, {2, 0, 0}, {0, 2, 2}), mirror(Vec3(1.0f)));
    builder.add(quadMesh({-1, -3, -2}, {2, 0, 0}, {0, 0, 4}), glass(1.5f));
    builder.add(quadMesh({-9, -9, -9}, {0, 0, 18}, {18, 0, 0}), lamp(Vec3(1.0f)));
    builder.add(quadMesh({-9, 9, -9}, {18, 0, 0}, {0, 0, 18}), lamp(Vec3(50.0f)));
    const auto traced = builder.build();
    const View view = patchView({0, 1, 0}, {0, 0, 1}, 1e-2, 32);
    const Estimate split = measure(traced, view, optionsOf(IntegratorKind::Path, 6), 1);
    // Kept hit points are one for each pixel, so that their paths find both ways by chance.
    const Estimate alone = measure(traced, view, optionsOf(IntegratorKind::Ppm, 6), 64);
    CAPTURE(split.mean(), split.standardError(), alone.mean(), alone.standardError());
    CHECK(split.standardError() < 1e-4 * split.mean());
    CHECK(alone.agrees(split.mean(), 1e-4));
}
