// PaneTest.cpp - paths and photons that go on behind panes. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Material pane(Vec3 tint)
{
    Material material = glass(1.5f);
    material.baseColor = tint;
    MaterialDetail thin;
    thin.thinWalled = true;
    material.detail = std::make_shared<MaterialDetail>(thin);
    return material;
}

/// Returns the same surface, but one whose paths are not reused, because its colour could change
/// from point to point.
Material varying(const Material& diffuse)
{
    Material material;
    material.diffuse = diffuse.baseColor;
    material.vertexColorUse = VertexColorUse::Ambient;
    return material;
}

/// Measures the Cornell box with a pane that leaves a quarter of the green light.
Estimate measureBox(const std::shared_ptr<const Mesh>& where, bool reused)
{
    SceneBuilder box = cornellBox();
    for (Material& material : box.scene->materials)
        if (!reused && material.emission == Vec3(0.0f)) material = varying(material);
    box.add(where, pane(Vec3(1.0f, 0.25f, 0.5f)));
    // The lamp is out of sight: its edge would be most of the noise.
    const View view = perspectiveView({278, 200, -800}, {278, 120, 279}, {0, 1, 0}, 15, 16, 16);
    return measure(box.build(), view, optionsOf(IntegratorKind::Path, 4), 32);
}

} // namespace

TEST_CASE("panes: paths that pixels share keep the tint of the panes that they pass",
          "[integrators][statistics]")
{
    const auto before = quadMesh({0, 0, -100}, {0, 548, 0}, {556, 0, 0});
    const auto across = quadMesh({0, 274, 0}, {0, 0, 559}, {556, 0, 0});
    for (const auto& where : {before, across})
    {
        const Estimate own = measureBox(where, false), reused = measureBox(where, true);
        const double error = std::hypot(own.standardError(), reused.standardError());
        CAPTURE(where == across, own.mean(), reused.mean(), error);
        CHECK(std::abs(own.mean() - reused.mean()) < 4.0 * error);
        CHECK(error < 0.02 * own.mean());
    }
}

TEST_CASE("panes: only the photons that pass them are traced again", "[integrators]")
{
    SceneBuilder builder;
    builder.add(quadMesh({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), lambert(Vec3(0.0f)));
    builder.add(quadMesh({-9, -9, 1}, {18, 0, 0}, {0, 18, 0}), pane(Vec3(0.5f)));
    builder.addQuadLight({-0.1f, 0.1f, 1.2f}, {0.2f, 0, 0}, {0, -0.2f, 0}, Vec3(5.0f));
    RenderOptions options = optionsOf(IntegratorKind::Ppm);
    options.photons = 20000;
    const View view = patchView({0, 0, 0.5}, {0, 0, 1}, 1.0, 8);
    const RenderProgress progress = render(builder.build(), view, options, 1).progress;
    const double rays = double(progress.rays.photon) / options.photons;
    CHECK(rays > 1.3); // a photon passes with a probability of 0.46 at most
    CHECK(rays < 1.7); // and few of the others are mirrored
}
