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

TEST_CASE("report: the hash of a scene changes with all that its picture can", "[report]")
{
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
    const auto sameMesh = [](Scene& scene) { return std::make_shared<Mesh>(*scene.meshes[0]); };
    const auto sameTexture = [&] { return std::make_shared<Texture>(*texture); };
    const std::function<void(Scene&, Material&)> edits[] = {
        [](Scene&, Material& m) { m.baseColor.x = 0.25f; },
        [](Scene&, Material& m) { m.lightMask = 1; },
        [](Scene&, Material& m) { m.moreLights = {1}; },
        [](Scene&, Material& m) { m.alpha = 0.5f; },
        [](Scene&, Material& m) { m.blended = true; },
        [](Scene&, Material& m) { m.alphaTest = AlphaTest::Less; },
        [](Scene&, Material& m) { m.alphaReference = 0.5f; },
        [](Scene&, Material& m) { m.culling = FaceCulling::Back; },
        [](Scene&, Material& m) { m.clockwise = true; },
        [](Scene&, Material& m) { m.separateSpecular = true; },
        [](Scene&, Material& m) { m.localViewer = true; },
        [](Scene&, Material& m) { m.hasBack = true; },
        [](Scene&, Material& m) { m.back.emission.z = 1.0f; },
        [](Scene&, Material& m) { m.back.alpha = 0.5f; },
        [](Scene&, Material& m) { m.environmentColor.y = 1.0f; },
        [](Scene&, Material& m) { m.mapping.coordinates = TextureCoordinates::Uv1; },
        [](Scene&, Material& m) { m.mapping.transformed = true; },
        [](Scene&, Material& m) { m.mapping.matrix[3][0] = 0.5f; },
        [](Scene&, Material& m) { m.mapping.partly = true; },
        [](Scene&, Material& m) { m.mapping.own = TextureCoordinates::Uv1; },
        [](Scene&, Material& m) { m.mapping.ownMatrix[3][0] = 0.5f; },
        [](Scene&, Material& m) { m.second.texture = 0; },
        [](Scene&, Material& m) { m.second.environment = TextureEnvironment::Add; },
        [](Scene&, Material& m) { m.second.mapping.matrix[3][0] = 0.5f; },
        [&](Scene& s, Material&)
        {
            const auto mesh = sameMesh(s);
            mesh->uvs1 = std::vector<Vec2>(4, Vec2(0.5f));
            s.meshes[0] = mesh;
        },
        [&](Scene& s, Material&)
        {
            const auto mesh = sameMesh(s);
            mesh->rs = std::vector<float>(4, 0.5f);
            s.meshes[0] = mesh;
        },
        [&](Scene& s, Material&)
        {
            const auto other = sameTexture();
            other->depth = 1;
            s.textures[0] = other;
        },
        [&](Scene& s, Material&)
        {
            const auto other = sameTexture();
            other->wrapR = TextureWrap::Mirror;
            s.textures[0] = other;
        },
        [&](Scene& s, Material&)
        {
            const auto other = sameTexture();
            other->wrapT = TextureWrap::Mirror;
            s.textures[0] = other;
        },
        [&](Scene& s, Material&)
        {
            const auto other = sameTexture();
            other->border.x = 1.0f;
            s.textures[0] = other;
        },
        [&](Scene& s, Material&)
        {
            const auto other = sameTexture();
            other->mips = {*texture};
            s.textures[0] = other;
        },
        [&](Scene& s, Material&)
        {
            const auto other = sameTexture();
            other->mips = {*texture};
            other->mips[0].linearFilter = false;
            s.textures[0] = other;
        },
        [&](Scene& s, Material&)
        {
            const auto other = sameTexture();
            other->mips = {*texture};
            other->blendsMips = false;
            s.textures[0] = other;
        },
        [](Scene& s, Material&) { s.lights[0].radius = 0.1f; },
        [](Scene& s, Material&) { s.lights[0].environment.visible = false; },
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
