// SubsurfaceBodiesTest.cpp - light that enters wax in one medium and leaves it in another one.
// SPDX-License-Identifier: MIT
//
// All tests have fixed seeds. Means have to agree within four standard errors, as Estimate says.
#include "tests/integrators/SubsurfaceScenes.h"

#include <cmath>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// A column of wax that stands partly in a box, through the box's top at z = 0.
SceneBuilder column(const Material& box)
{
    SceneBuilder builder;
    builder.add(boxMesh(Vec3(-0.3f, -0.3f, -0.5f), Vec3(0.3f, 0.3f, 0.3f)),
                wax(Vec3(0.95f), Vec3(0.2f)));
    builder.add(boxMesh(Vec3(-1.0f, -1.0f, -1.0f), Vec3(1.0f, 1.0f, 0.0f)), box);
    return builder;
}

} // namespace

TEST_CASE("subsurface: paths that leave a body outside of a medium do not take it along",
          "[statistics][subsurface][media]")
{
    // The box lets no light through but that of the short way from the wax to the eye within it, as
    // a box with black faces does.
    const float sigma = 1000.0f;
    const double side = 0.002;
    const auto scene = [](const Material& box)
    {
        SceneBuilder builder = column(box);
        addSky(builder);
        return builder.build();
    };
    const View view = patchView({0.3, 0.0, -0.05}, {1, 0, 0}, side, 16);
    const RenderOptions options = optionsOf(IntegratorKind::Path, 32);
    const Estimate expected = measure(scene(lambert(Vec3(0.0f))), view, options, 8);
    const Estimate seen = measure(scene(bodyOf(mediumOf(sigma, 0.0f))), view, options, 8);
    const double share = std::exp(-double(sigma) * 0.5 * side); // rays begin at the near plane
    CAPTURE(seen.mean(), seen.standardError(), share * expected.mean(), expected.mean());
    CHECK(expected.mean() > 0.05);
    // The faces are as sharp as a mean free path of 0.001 within 0.2.
    CHECK(seen.agrees(share * expected.mean(),
                      share * (4.0 * expected.standardError() + 0.01 * expected.mean())));
}

TEST_CASE("subsurface: photons that leave a body outside of a medium do not take it along",
          "[statistics][subsurface][media]")
{
    // The lamp is within the box, and the eye sees a wall above it.
    SceneBuilder builder = column(bodyOf(mediumOf(4.0f, 0.0f)));
    builder.addQuadLight({0.5f, -0.2f, -0.25f}, {0.0f, 0.0f, 0.2f}, {0.0f, 0.4f, 0.0f},
                         Vec3(100.0f));
    builder.add(quadMesh({0.7f, -0.8f, 0.05f}, {0.0f, 0.0f, 0.8f}, {0.0f, 1.6f, 0.0f}),
                lambert(Vec3(0.6f)));
    const auto traced = builder.build();
    const View view = patchView({0.7f, 0.0f, 0.5f}, {-1, 0, 0}, 0.2, 16);
    RenderOptions options = optionsOf(IntegratorKind::Path, 5);
    const Estimate expected = measure(traced, view, options, 48);
    options.photons = 10000;
    options.integrator = IntegratorKind::Sppm;
    const Estimate seen = measure(traced, view, options, 6);
    CAPTURE(seen.mean(), seen.standardError(), expected.mean(), expected.standardError());
    CHECK(expected.standardError() < 0.02 * expected.mean());
    CHECK(seen.agrees(expected.mean(), 4.0 * expected.standardError() + 0.01 * expected.mean()));
}
