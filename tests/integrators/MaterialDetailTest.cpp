// MaterialDetailTest.cpp - attenuation within bodies, vertex colours and places of textures. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "tests/integrators/MaterialDetails.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("attenuation: light that crosses a body falls by Beer's law", "[integrators]")
{
    MaterialDetail detail;
    detail.interior.sigmaA = absorptionOf(Vec3(0.5f, 0.25f, 1.0f), 4.0f);
    for (const double unit : {1.0, 2.0})
        for (const IntegratorKind kind : kKinds)
        {
            SceneBuilder builder;
            builder.scene->unit = unit; // the distance is in the world's lengths
            builder.add(boxMesh({-1, -1, 1}, {1, 1, 3}), withDetail(glass(1.0f), detail));
            builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lamp(Vec3(8.0f)));
            const View view = patchView({0, 0, 4.0 * unit}, {0, 0, 1}, 0.01, 4);
            const Vec3 seen = render(builder.build(), view, optionsOf(kind), 1).mean();
            const double share = 2.0 * unit / 4.0;
            CAPTURE(int(kind), unit);
            CHECK(seen.x == Approx(8.0 * std::pow(0.5, share)).epsilon(1e-4));
            CHECK(seen.y == Approx(8.0 * std::pow(0.25, share)).epsilon(1e-4));
            CHECK(seen.z == Approx(8.0).epsilon(1e-4));
        }
}

TEST_CASE("attenuation: photons lose what paths lose", "[integrators][statistics][long]")
{
    MaterialDetail detail;
    detail.interior.sigmaA = absorptionOf(Vec3(0.3f), 0.5f);
    const auto scene = [&](bool absorbs)
    {
        SceneBuilder builder;
        builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(0.7f)));
        const Material body = absorbs ? withDetail(glass(1.5f), detail) : glass(1.5f);
        builder.add(boxMesh({-0.5f, -0.5f, 0.4f}, {0.5f, 0.5f, 0.9f}), body);
        builder.addQuadLight({-0.5f, 0.5f, 1.9f}, {1, 0, 0}, {0, -1, 0}, Vec3(5.0f));
        return builder.build();
    };
    const View view = perspectiveView({0.9, -0.9, 0.35}, {0, 0, 0}, {0, 0, 1}, 40.0, 24, 24);
    const Estimate clear = measure(scene(false), view, optionsOf(IntegratorKind::Path, 12), 64);
    const Estimate paths = measure(scene(true), view, optionsOf(IntegratorKind::Path, 12), 64);
    CHECK(paths.mean() < 0.95 * clear.mean());
    RenderOptions options = optionsOf(IntegratorKind::PhotonCaustics, 12);
    options.photons = 20000;
    const Estimate photons = measure(scene(true), view, options, 16);
    CAPTURE(clear.mean(), paths.mean(), photons.mean());
    const double spread = 4.0 * std::hypot(paths.standardError(), photons.standardError());
    CHECK(std::abs(paths.mean() - photons.mean()) < spread + 0.02 * paths.mean());
}

TEST_CASE("vertex colours multiply base colour and alpha, and places move textures",
          "[integrators]")
{
    MaterialDetail detail;
    detail.vertexColors = true;
    detail.places[kBaseColorRole].set = 1;
    detail.places[kBaseColorRole].u = Vec2(0.0f); // the texel at 0.75 everywhere
    detail.places[kBaseColorRole].v = Vec2(0.0f);
    detail.places[kBaseColorRole].offset = Vec2(0.75f, 0.5f);
    auto stripes = std::make_shared<Texture>();
    stripes->width = 2;
    stripes->height = 1;
    stripes->linearFilter = false;
    stripes->floats = {1, 1, 1, 1, 0.5f, 1.0f, 1.0f, 1.0f};
    for (const bool blended : {false, true})
    {
        SceneBuilder builder;
        builder.scene->textures = {stripes};
        const auto mesh = quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
        mesh->colors = std::vector<Vec4>(4, Vec4(0.5f, 0.25f, 1.0f, 0.0f));
        Material material = withDetail(lambert(Vec3(0.8f)), detail);
        material.baseColorTexture = 0;
        material.blended = blended; // alpha 0: nothing is left of it
        builder.add(mesh, material);
        builder.addLight(slanted(0.0f));
        for (const IntegratorKind kind : kKinds)
        {
            const Vec3 seen = render(builder.build(), fromAbove(), optionsOf(kind), 1).mean();
            CAPTURE(int(kind), blended);
            const Vec3 expected = blended ? Vec3(0.0f) : Vec3(0.2f, 0.2f, 0.8f);
            CHECK(glm::length(seen - expected) < 1e-5f);
        }
    }
}
