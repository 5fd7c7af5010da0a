// FirstHitTest.cpp - what is recorded of the surfaces that camera rays meet first. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/SurfaceSample.h"
#include "osgRayTrace/session/image/ResolvedImage.h"
#include "osgRayTrace/session/image/SurfaceMap.h"
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include <functional>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kPixels = 8;

/// Renders a pass through the middles of the pixels of a square around (0, 0, 1), seen along -z.
void renderCentres(RenderSession& session, const SceneBuilder& builder, IntegratorKind kind)
{
    RenderOptions options = optionsOf(kind);
    options.centredFirstPass = true;
    session.setScene(builder.build());
    session.setView(perspectiveView({0, 0, 3}, {0, 0, 1}, {0, 1, 0}, 30.0, kPixels, kPixels));
    session.setOptions(options);
    session.setKeepsSurfaces(true);
    StopRule rule;
    rule.passes = 1;
    REQUIRE(session.render(rule).status.ok());
}

std::shared_ptr<Mesh> quadAt(float z)
{
    const auto mesh = quadMesh({-1, -1, z}, {2, 0, 0}, {0, 2, 0});
    mesh->uvs = std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    return mesh;
}

Material withDetail(Material material, const std::function<void(MaterialDetail&)>& set)
{
    MaterialDetail detail;
    set(detail);
    material.detail = std::make_shared<MaterialDetail>(detail);
    return material;
}

Material coated(Material base, float roughness, uint32_t texture = kInvalid)
{
    return withDetail(base,
                      [&](MaterialDetail& detail)
                      {
                          detail.clearcoat = 1.0f;
                          detail.clearcoatRoughness = roughness;
                          detail.textures[kClearcoatRole] = texture;
                      });
}

Material metal(float roughness)
{
    Material material = mirror(Vec3(0.9f));
    material.roughness = roughness;
    return material;
}

struct SeenLobes
{
    float left, right;
};

/// Returns the lobes that the surface map has of a quad at its left and right side. Texture 0 is
/// black on the left and white on the right.
SeenLobes lobesOf(const Material& material)
{
    auto halves = std::make_shared<Texture>();
    halves->width = 2;
    halves->height = 1;
    halves->linearFilter = false;
    halves->floats = {0, 0, 0, 1, 1, 1, 1, 1};
    SceneBuilder builder;
    builder.scene->textures = {halves};
    builder.add(quadAt(1.0f), material);
    RenderSession session(std::make_shared<Workers>(1));
    renderCentres(session, builder, IntegratorKind::Path);
    const SurfaceMap& map = session.surfaces();
    const std::vector<SurfaceSample>& samples = session.surfaceSamples();
    const std::size_t left = kPixels / 2 * kPixels, right = left + kPixels - 1;
    CHECK(samples[left].lobe == map.lobe[left]);
    CHECK(samples[right].lobe == map.lobe[right]);
    return {map.lobe[left], map.lobe[right]};
}

float lobeOf(const Material& material)
{
    const SeenLobes seen = lobesOf(material);
    CHECK(seen.left == seen.right);
    return seen.left;
}

} // namespace

TEST_CASE("first hits: a pane is what is seen first, by paths and by Whitted's rays",
          "[integrators]")
{
    SceneBuilder builder;
    builder.add(quadAt(1.0f), withDetail(glass(1.5f), [](auto& d) { d.thinWalled = true; }));
    builder.add(quadAt(0.0f), lambert(Vec3(0.5f)));
    RenderSession path(std::make_shared<Workers>(1)), whitted(std::make_shared<Workers>(1));
    renderCentres(path, builder, IntegratorKind::Path);
    renderCentres(whitted, builder, IntegratorKind::Whitted);
    const SurfaceMap &seen = path.surfaces(), &expected = whitted.surfaces();
    for (std::size_t i = 0; i < kPixels * kPixels; ++i)
    {
        CAPTURE(i);
        REQUIRE(expected.object[i] == 1);
        REQUIRE(seen.object[i] == 1);
        REQUIRE(seen.along[i] == expected.along[i]);
        REQUIRE(seen.lobe[i] == 0.0f);
        const SurfaceSample &sample = path.surfaceSamples()[i],
                            &other = whitted.surfaceSamples()[i];
        REQUIRE(sample.object == 1);
        REQUIRE(sample.distance == other.distance);
        REQUIRE(sample.albedo == other.albedo);
        REQUIRE(sample.kind == SurfaceKind::Smooth);
    }
    CHECK(path.resolvedImage().depth == whitted.resolvedImage().depth);
}

TEST_CASE("first hits: the lobe of a surface is the narrowest of its layers", "[integrators]")
{
    CHECK(lobeOf(lambert(Vec3(0.5f))) == kInfinity);
    CHECK(lobeOf(metal(0.4f)) == Approx(0.16f));
    CHECK(lobeOf(metal(0.0f)) == 0.0f);
    CHECK(lobeOf(coated(metal(1.0f), 0.0f)) == 0.0f);
    CHECK(lobeOf(coated(lambert(Vec3(0.5f)), 0.0f)) == 0.0f);
    CHECK(lobeOf(coated(metal(1.0f), 0.4f)) == Approx(0.16f));
    CHECK(lobeOf(coated(metal(0.2f), 0.4f)) == Approx(0.04f));
    const SeenLobes part = lobesOf(coated(lambert(Vec3(0.5f)), 0.0f, 0));
    CHECK(part.left == kInfinity);
    CHECK(part.right == 0.0f);
}

TEST_CASE("first hits: what is seen through frosted glass looks otherwise from elsewhere",
          "[integrators]")
{
    CHECK(lobeOf(glass(1.5f)) == 0.0f);
    CHECK(lobeOf(glass(1.5f, 0.5f)) == 0.0f);
    Material stained = glass(1.5f, 0.5f);
    stained.baseColorTexture = 0; // black glass shows nothing but what it mirrors
    const SeenLobes part = lobesOf(stained);
    CHECK(part.left == Approx(0.25f));
    CHECK(part.right == 0.0f);
}
