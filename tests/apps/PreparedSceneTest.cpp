// PreparedSceneTest.cpp - a kept reference picture is used only for the scene that it was rendered
// from.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "apps/osgraytracebench/report/PreparedScene.h"

#include <functional>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;
using osgRayTrace::bench::hashOf;

TEST_CASE("report: the hash of a scene changes with its values", "[report]")
{
    // scene/SceneDigestTest has all of them.
    SceneBuilder builder;
    builder.add(quadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), lambert(Vec3(0.5f)));
    builder.addLight(pointLight({0, 0, 1}));
    const auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 1;
    texture->bytes = {255, 255, 255, 255};
    builder.scene->textures = {texture};
    const auto hashAfter = [&](const std::function<void(Scene&, Material&)>& edit)
    {
        Scene scene = *builder.scene;
        edit(scene, scene.materials[scene.instances[0].material]);
        osgRayTrace::bench::PreparedScene prepared;
        prepared.traced =
            TracedScene::build(std::make_shared<Scene>(scene), std::make_shared<Workers>(1));
        return hashOf(prepared, {});
    };
    const std::function<void(Scene&, Material&)> edits[] = {
        [](Scene&, Material& m) { m.baseColor.x = 0.25f; },
        [](Scene& s, Material&)
        {
            const auto mesh = std::make_shared<Mesh>(*s.meshes[0]);
            mesh->uvs1 = std::vector<Vec2>(4, Vec2(0.5f));
            s.meshes[0] = mesh;
        },
        [&](Scene& s, Material&)
        {
            const auto other = std::make_shared<Texture>(*texture);
            other->border.x = 1.0f;
            s.textures[0] = other;
        },
        [](Scene& s, Material&) { s.lights[0].radius = 0.1f; },
    };
    std::vector<uint64_t> hashes{hashAfter([](Scene&, Material&) {})};
    CHECK(hashAfter([](Scene&, Material&) {}) == hashes[0]);
    for (const auto& edit : edits)
    {
        CAPTURE(hashes.size() - 1);
        hashes.push_back(hashAfter(edit));
        CHECK(std::count(hashes.begin(), hashes.end(), hashes.back()) == 1);
    }
}

TEST_CASE("report: the hash of a scene changes with the options of its picture", "[report]")
{
    SceneBuilder builder;
    builder.add(quadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), lambert(Vec3(0.5f)));
    osgRayTrace::bench::PreparedScene prepared;
    prepared.traced = builder.build();
    const auto hashWith = [&](const std::function<void(RenderOptions&)>& edit)
    {
        osgRayTrace::bench::Method method;
        edit(method.options);
        return hashOf(prepared, method);
    };
    const uint64_t plain = hashWith([](RenderOptions&) {});
    CHECK(hashWith([](RenderOptions& o) { o.seed = 7; }) == plain); // seeds have files of their own
    const std::function<void(RenderOptions&)> edits[] = {
        [](RenderOptions& o) { o.integrator = IntegratorKind::Path; },
        [](RenderOptions& o) { o.maxBounces = 3; },
        [](RenderOptions& o) { o.shadows = false; },
        [](RenderOptions& o) { o.aperture = 0.1f; },
        [](RenderOptions& o) { o.focus = 2.0f; },
        [](RenderOptions& o) { o.photonGuiding = false; },
    };
    for (std::size_t i = 0; i < std::size(edits); ++i)
    {
        CAPTURE(i);
        CHECK(hashWith(edits[i]) != plain);
    }
}
