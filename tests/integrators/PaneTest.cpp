// PaneTest.cpp - paths that go on behind panes. Layer: tests.
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
