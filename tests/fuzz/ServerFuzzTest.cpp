// ServerFuzzTest.cpp - damaged messages to render servers and viewers are refused, and take memory
// within reason.
// SPDX-License-Identifier: MIT
#include "CountedMemory.h"
#include "FuzzSeeds.h"
#include "tests/Catch.h"
#include "tests/scene/SceneEdits.h"

#include "osgRayTrace/servers/BuildIdentity.h"
#include "osgRayTrace/servers/SceneWire.h"
#include "osgRayTrace/servers/ServerMessages.h"
#include "osgRayTrace/servers/TileServer.h"

#include <cstring>
#include <string>
#include <vector>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;
using namespace osgRayTrace::test;

namespace
{

constexpr std::size_t kMostBytes = std::size_t(1) << 22; // for messages of a few KiB

Bytes damaged(const Bytes& message, Dice& dice)
{
    std::string text(message.begin(), message.end());
    const int times = 1 + dice.below(3);
    for (int i = 0; i < times && !text.empty(); ++i)
    {
        if (dice.oneIn(3) && text.size() >= 8) // a number where one may be
        {
            const uint64_t numbers[] = {0, 1, 64, 65, 0xffffffff, uint64_t(1) << 40, ~uint64_t(0)};
            const uint64_t number = dice.oneOf(numbers);
            std::memcpy(&text[static_cast<std::size_t>(dice.below(int(text.size()) - 7))], &number,
                        dice.oneIn(2) ? 8 : 4);
        }
        else
            damageBytes(text, dice.below(kDamages), dice);
    }
    return Bytes(text.begin(), text.end());
}

/// Adds an environment, and a lamp that fills the view of identity.
void shine(Scene& scene)
{
    scene.lights[0].kind = LightKind::Environment;
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = std::vector<Vec3>{Vec3(-9, -9, 0), Vec3(9, -9, 0), Vec3(0, 9, 0)};
    mesh->triangles = std::vector<UVec3>{UVec3(0, 1, 2), UVec3(0, 2, 1)};
    Instance instance;
    instance.mesh = static_cast<uint32_t>(scene.meshes.size());
    instance.light = static_cast<uint32_t>(scene.lights.size());
    Light light;
    light.kind = LightKind::Mesh;
    light.instance = static_cast<uint32_t>(scene.instances.size());
    light.radiance = Vec3(1.0f);
    scene.meshes.push_back(mesh);
    scene.instances.push_back(instance);
    scene.lights.push_back(light);
}

/// Lets a light or an instance name what another one should: bytes at random seldom do.
void mislead(Scene& scene, Dice& dice)
{
    const auto index = [&](std::size_t size)
    { return dice.oneIn(3) ? kInvalid : static_cast<uint32_t>(dice.below(int(size))); };
    Light& light = scene.lights[index(1) == kInvalid ? 0 : 1];
    Instance& instance = scene.instances[index(1) == kInvalid ? 0 : 1];
    light.instance = index(scene.instances.size());
    instance.light = index(scene.lights.size());
    instance.mesh = static_cast<uint32_t>(dice.below(int(scene.meshes.size())));
    if (dice.oneIn(2))
        light.kind = static_cast<LightKind>(dice.below(1 + int(LightKind::Environment)));
    if (dice.oneIn(2)) light.environment.image = nullptr;
}

} // namespace

TEST_CASE("fuzz: damaged scenes are refused or can be traced", "[fuzz]")
{
    const std::vector<Edit> all = edits();
    int taken = 0, refused = 0;
    forEachSeed(20000,
                [&](uint32_t seed)
                {
                    Dice dice(seed);
                    Scene scene = someScene();
                    SceneSender sender;
                    SceneReceiver receiver;
                    Bytes message = sender.message(scene);
                    if (dice.oneIn(2)) // damage a change
                    {
                        REQUIRE(receiver.take(message));
                        all[static_cast<std::size_t>(dice.below(int(all.size())))](scene);
                        message = sender.message(scene);
                    }
                    message = damaged(message, dice);
                    takeMemoryPeak();
                    const auto result = receiver.take(message);
                    CHECK(takeMemoryPeak().single < kMostBytes);
                    ++(result ? taken : refused);
                    CHECK(receiver.fault().empty() == (result != nullptr));
                });
    CHECK(refused > taken);
}

TEST_CASE("fuzz: a server survives damaged messages", "[fuzz]")
{
    const auto workers = std::make_shared<Workers>(1);
    std::vector<Bytes> answers;
    uint64_t traced = 0;
    const auto survive = [&](uint32_t seed)
    {
        Dice dice(seed);
        answers.clear();
        TileServer server(workers, [&](const std::string&, Bytes&& message)
                          { answers.push_back(std::move(message)); });
        SceneSender sender;
        const bool isPath = dice.oneIn(2); // paths look lights up in tables
        Scene scene = someScene();
        if (isPath) shine(scene);
        if (isPath && dice.oneIn(4)) mislead(scene, dice);
        PassOrder order;
        order.number = 1;
        order.scene = 2;
        order.pass.scene = nullptr;
        order.pass.view.width = order.pass.view.height = isPath ? 8 : 40;
        order.pass.options.integrator = isPath ? IntegratorKind::Path : IntegratorKind::Whitted;
        std::vector<Bytes> messages = {messageOf(Hello{1, buildIdentity()}),
                                       sceneMessage(2, sender.message(scene)), messageOf(order),
                                       messageOf(TileOrders{1, 3, {0, 1, 2}, false, {}})};
        if (dice.oneIn(4)) messages.push_back(dropMessage(1));
        const std::size_t bad = dice.oneIn(2) ? 1 // scenes have the most to damage
                                              : static_cast<std::size_t>(dice.below(8));
        if (bad < messages.size()) messages[bad] = damaged(messages[bad], dice);
        for (const Bytes& message : messages)
            server.take("viewer", message);
        while (server.work())
            ;
        CHECK(!answers.empty());
        traced += server.tilesTraced();
    };
    forEachSeed(2000, survive);
    CHECK(traced > static_cast<uint64_t>(seedCount(2000)) / 4);
}

TEST_CASE("fuzz: damaged answers are refused", "[fuzz]")
{
    TracedTiles traced;
    traced.pass = 1;
    traced.group = 2;
    traced.seconds = 0.1;
    traced.depth = traced.surfaces = true;
    traced.tiles = {3, 4};
    const std::vector<TracedTile> results(2);
    const Bytes whole = messageOf(traced, results.data());
    forEachSeed(5000,
                [&](uint32_t seed)
                {
                    Dice dice(seed);
                    const Bytes message = damaged(whole, dice);
                    takeMemoryPeak();
                    WireReader in(message);
                    MessageKind kind{};
                    TracedTiles result;
                    if (!takeKind(in, kind) || !takeMessage(in, result)) return;
                    TracedTile tile;
                    std::size_t tiles = 0;
                    while (tiles < result.tiles.size() && takeTile(in, result, tile))
                        ++tiles;
                    CHECK(tiles <= result.tiles.size());
                    CHECK(takeMemoryPeak().single < kMostBytes);
                });
}
