// SceneWireTest.cpp - scenes and their changes arrive as they were sent, and only changes travel.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/scene/SceneEdits.h"

#include "osgRayTrace/scene/SceneDigest.h"
#include "osgRayTrace/servers/SceneFault.h"
#include "osgRayTrace/servers/SceneWire.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a scene that can be traced, for edits of it: materials and lights name what is there.
Scene tracedScene()
{
    Scene scene = someScene();
    scene.meshes.push_back(scene.meshes[0]);
    scene.materials.push_back(scene.materials[0]);
    scene.lights.push_back(Light());
    return scene;
}

bool isSound(const Scene& scene)
{
    bool sound = !sceneFault(scene);
    for (const auto& mesh : scene.meshes)
        sound = sound && !meshFault(*mesh);
    for (const auto& texture : scene.textures)
        sound = sound && !textureFault(*texture);
    return sound;
}

} // namespace

TEST_CASE("wire: each value that images depend on arrives, alone and as a change", "[servers]")
{
    int sound = 0, refused = 0;
    const std::vector<Edit> all = edits();
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        CAPTURE(i);
        Scene scene = tracedScene();
        SceneSender changes, whole;
        SceneReceiver changed, received;
        REQUIRE(changed.take(changes.message(scene)));
        all[i](scene);
        const auto afterChange = changed.take(changes.message(scene));
        const auto afterAll = received.take(whole.message(scene));
        if (!isSound(scene))
        {
            ++refused;
            CHECK(!afterChange);
            CHECK(!afterAll);
            CHECK(!received.fault().empty());
            continue;
        }
        ++sound;
        REQUIRE(afterChange);
        REQUIRE(afterAll);
        CHECK(sceneDigest(*afterChange) == sceneDigest(scene));
        CHECK(sceneDigest(*afterAll) == sceneDigest(scene));
    }
    CHECK(sound >= 120);
    CHECK(refused <= 16);
}

TEST_CASE("wire: stamps arrive", "[servers]")
{
    Scene scene = tracedScene();
    scene.changed = 7;
    scene.instances[0].changed = 8;
    scene.materials[1].changed = 9;
    scene.lights[1].changed = 10;
    ofMesh(
        [](Mesh& mesh)
        {
            mesh.changed = 11;
            mesh.deforms = true;
        })(scene);
    ofTexture([](Texture& texture) { texture.changed = 12; })(scene);
    SceneSender sender;
    SceneReceiver receiver;
    const auto received = receiver.take(sender.message(scene));
    REQUIRE(received);
    CHECK(received->changed == 7);
    CHECK(received->instances[0].changed == 8);
    CHECK(received->materials[1].changed == 9);
    CHECK(received->lights[1].changed == 10);
    CHECK(received->meshes[0]->changed == 11);
    CHECK(received->meshes[0]->deforms);
    CHECK(received->textures[0]->changed == 12);
}

TEST_CASE("wire: only what has changed travels, and the rest stays where it was", "[servers]")
{
    SceneBuilder builder = cornellBox();
    builder.add(sphereMesh(Vec3(200, 100, 200), 50.0f, 60), lambert(Vec3(0.5f)));
    Scene scene = *builder.scene;
    for (int i = 0; i < 1000; ++i)
        scene.instances.push_back(scene.instances[0]);
    SceneSender sender;
    SceneReceiver receiver;
    const Bytes first = sender.message(scene);
    const auto before = receiver.take(first);
    REQUIRE(before);

    SECTION("nothing")
    {
        CHECK(sender.message(scene).size() < 400);
    }
    SECTION("a place")
    {
        scene.instances[500].placed = true;
        scene.instances[500].engineFromLocal.translation.x = 1.0f;
        const Bytes change = sender.message(scene);
        CHECK(change.size() < 6000); // a block of 64 instances
        const auto after = receiver.take(change);
        REQUIRE(after);
        CHECK(after->meshes == before->meshes);
        CHECK(sceneDigest(*after) == sceneDigest(scene));
    }
    SECTION("positions")
    {
        auto mesh = std::make_shared<Mesh>(*scene.meshes.back());
        std::vector<Vec3> positions(mesh->positions.begin(), mesh->positions.end());
        positions[0].x += 1.0f;
        mesh->positions = std::move(positions);
        mesh->deforms = true;
        const auto kept = scene.meshes.back();
        scene.meshes.back() = mesh;
        const Bytes change = sender.message(scene);
        CHECK(change.size() < mesh->positions.size() * sizeof(Vec3) + 400);
        const auto after = receiver.take(change);
        REQUIRE(after);
        CHECK(after->meshes.back()->triangles.data() == before->meshes.back()->triangles.data());
        CHECK(after->meshes[0] == before->meshes[0]);
        CHECK(sceneDigest(*after) == sceneDigest(scene));
    }
    SECTION("an array that is edited in place, while its old mesh lives")
    {
        auto values = std::make_shared<std::vector<Vec3>>(scene.meshes.back()->positions.begin(),
                                                          scene.meshes.back()->positions.end());
        auto mesh = std::make_shared<Mesh>(*scene.meshes.back());
        mesh->positions = SharedArray<Vec3>(values->data(), values->size(), values);
        scene.meshes.back() = mesh;
        REQUIRE(receiver.take(sender.message(scene)));
        (*values)[0].x += 1.0f;
        scene.meshes.back() = std::make_shared<Mesh>(*mesh);
        const auto after = receiver.take(sender.message(scene));
        REQUIRE(after);
        CHECK(after->meshes.back()->positions[0] == (*values)[0]);
        CHECK(sceneDigest(*after) == sceneDigest(scene));
    }
    SECTION("a mesh that goes, and another one in its memory")
    {
        for (int i = 0; i < 20; ++i)
        {
            scene.meshes.back() = nullptr;
            scene.meshes.back() = sphereMesh(Vec3(200, 100, float(i)), 50.0f, 3);
            const auto after = receiver.take(sender.message(scene));
            REQUIRE(after);
            CHECK(sceneDigest(*after) == sceneDigest(scene));
        }
    }
    SECTION("fewer instances, then more")
    {
        scene.instances.resize(30);
        REQUIRE(receiver.take(sender.message(scene)));
        scene.instances.resize(300, scene.instances[0]);
        const auto after = receiver.take(sender.message(scene));
        REQUIRE(after);
        CHECK(sceneDigest(*after) == sceneDigest(scene));
    }
}

TEST_CASE("wire: pictures of a scene that has travelled are the same bit by bit", "[servers]")
{
    SceneBuilder builder = cornellBox();
    builder.add(sphereMesh(Vec3(400, 120, 120), 60.0f, 24), glass(1.5f));
    builder.add(sphereMesh(Vec3(100, 300, 300), 60.0f, 24), mirror(Vec3(0.9f)));
    SceneSender sender;
    SceneReceiver receiver;
    const auto received = receiver.take(sender.message(*builder.scene));
    REQUIRE(received);
    const auto workers = std::make_shared<Workers>(1);
    const auto there = TracedScene::build(received, workers);
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::PhotonCaustics})
    {
        RenderOptions options = optionsOf(kind);
        options.photons = 5000;
        const View view = cornellView(40, 40);
        CHECK(render(there, view, options, 2, 1).rgba ==
              render(builder.build(1), view, options, 2, 1).rgba);
    }
}

TEST_CASE("wire: scenes that the engine could not trace are refused", "[servers]")
{
    const std::string kNoLight = "an instance names a light that is not its own";
    const std::vector<std::pair<Edit, std::string>> wrong = {
        {ofMesh([](Mesh& m) { m.triangles = std::vector<UVec3>{UVec3(0, 1, 3)}; }),
         "a mesh has a triangle of vertices that it lacks"},
        {ofMesh(
             [](Mesh& m) {
                 m.positions = std::vector<Vec3>{Vec3(0.0f), Vec3(1.0f), Vec3(kInfinity)};
             }),
         "a mesh has a position that is not finite"},
        {ofMesh([](Mesh& m) { m.colors = std::vector<Vec4>(2); }),
         "the arrays of a mesh are of different lengths"},
        {ofTexture([](Texture& t) { t.mips.resize(1); }),
         "a texture is not of the size that it says"},
        {[](Scene& s) { s.unit = 0.0; }, "a scene has no place"},
        {[](Scene& s) { s.materials.clear(); }, "a scene has no materials"},
        {[](Scene& s) { s.instances[0].mesh = 2; }, "an instance names what the scene lacks"},
        {[](Scene& s) { s.materials[0].second.texture = 1; },
         "a material names a texture that the scene lacks"},
        {[](Scene& s) { s.lights[1].kind = LightKind::Mesh; },
         "a light names an instance that the scene lacks"},
        {[](Scene& s)
         {
             s.lights[1].kind = LightKind::Environment;
             s.lights[1].environment.image = nullptr;
         },
         "an environment light has no image"},
        {[](Scene& s) { s.instances[0].light = 1; }, kNoLight},
        {[](Scene& s)
         {
             s.instances.push_back(s.instances[0]);
             s.lights[1].kind = LightKind::Mesh;
             s.lights[1].instance = 0;
             s.instances[1].light = 1;
         },
         kNoLight},
    };
    for (const auto& [edit, fault] : wrong)
    {
        Scene scene = tracedScene();
        edit(scene);
        SceneSender sender;
        SceneReceiver receiver;
        CHECK(!receiver.take(sender.message(scene)));
        CHECK(receiver.fault() == fault);
    }
}

TEST_CASE("wire: what names nothing is refused", "[servers]")
{
    SceneReceiver receiver;
    CHECK(!receiver.take(Bytes()));
    CHECK(!receiver.fault().empty());
    Scene scene = tracedScene();
    SceneSender sender;
    const Bytes first = sender.message(scene);
    const Bytes change = sender.message(scene);
    SceneReceiver late;
    CHECK(!late.take(change)); // of a scene that it never got
    SceneReceiver twice;
    CHECK(twice.take(first));
    CHECK(!twice.take(first)); // its parts are there already
}
