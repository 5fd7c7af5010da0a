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
    const Scene scene = someScene();
    std::vector<Bytes> answers;
    forEachSeed(2000,
                [&](uint32_t seed)
                {
                    Dice dice(seed);
                    answers.clear();
                    TileServer server(workers, [&](const std::string&, Bytes&& message)
                                      { answers.push_back(std::move(message)); });
                    SceneSender sender;
                    PassOrder order;
                    order.number = 1;
                    order.scene = 2;
                    order.pass.scene = nullptr;
                    order.pass.view.width = order.pass.view.height = 40;
                    order.pass.options.integrator = IntegratorKind::Whitted;
                    std::vector<Bytes> messages = {
                        messageOf(Hello{1, buildIdentity()}),
                        sceneMessage(2, sender.message(scene)), messageOf(order),
                        messageOf(TileOrders{1, 3, {0, 1, 2}, false, {}}), dropMessage(1)};
                    const auto bad =
                        static_cast<std::size_t>(dice.below(int(messages.size()) * 3 / 2));
                    if (bad < messages.size()) messages[bad] = damaged(messages[bad], dice);
                    for (const Bytes& message : messages)
                        server.take("viewer", message);
                    while (server.work())
                        ;
                    CHECK(!answers.empty());
                });
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
