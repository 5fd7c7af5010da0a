// TileServerTest.cpp - what a render server answers, and whom it refuses.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/servers/BuildIdentity.h"
#include "osgRayTrace/servers/SceneWire.h"
#include "osgRayTrace/servers/ServerMessages.h"
#include "osgRayTrace/servers/TileServer.h"

#include <string>
#include <utility>
#include <vector>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// A server whose messages are kept.
struct Fixture
{
    std::vector<std::pair<std::string, Bytes>> sent;
    double seconds = 0.0;
    TileServer server{std::make_shared<Workers>(1),
                      [this](const std::string& viewer, Bytes&& message)
                      { sent.emplace_back(viewer, std::move(message)); },
                      [this] { return seconds; }};

    MessageKind kindOfLast() const
    {
        REQUIRE(!sent.empty());
        WireReader in(sent.back().second);
        MessageKind kind{};
        REQUIRE(takeKind(in, kind));
        return kind;
    }
    template <class Message> Message last() const
    {
        WireReader in(sent.back().second);
        MessageKind kind{};
        Message message;
        REQUIRE(takeKind(in, kind));
        REQUIRE(takeMessage(in, message));
        return message;
    }
    void hello(const std::string& viewer)
    {
        server.take(viewer, messageOf(Hello{1, buildIdentity()}));
    }
};

PassOrder boxPass(uint64_t number, uint64_t scene)
{
    PassOrder order;
    order.number = number;
    order.scene = scene;
    order.pass.view = cornellView(40, 40);
    order.pass.options = optionsOf(IntegratorKind::Path);
    order.pass.wantsDepth = true;
    return order;
}

} // namespace

TEST_CASE("tile server: other versions are refused by name", "[servers]")
{
    Fixture f;
    f.server.take("a", messageOf(Hello{1, "osgRayTrace 0.1, x86-64"}));
    REQUIRE(f.kindOfLast() == MessageKind::Refusal);
    const std::string reason = f.last<Refusal>().reason;
    CHECK(reason == "the server is " + buildIdentity() + ", the viewer is osgRayTrace 0.1, x86-64");
    CHECK(f.last<Refusal>().lasts);
    CHECK(f.server.viewers() == 0);
    f.hello("a");
    CHECK(f.kindOfLast() == MessageKind::Welcome);
    CHECK(f.last<Welcome>().threads == 1);
    CHECK(f.server.viewers() == 1);
}

TEST_CASE("tile server: strangers are told, the silent are forgotten", "[servers]")
{
    Fixture f;
    f.server.take("a", dropMessage(1));
    CHECK(f.kindOfLast() == MessageKind::Stranger);
    f.hello("a");
    f.seconds += TileServer::kForgets + 1.0;
    f.hello("b");
    CHECK(f.server.viewers() == 1);
    f.server.take("b", plainMessage(MessageKind::Bye));
    CHECK(f.server.viewers() == 0);
    f.hello("c");
    f.seconds += TileServer::kForgets + 1.0;
    f.server.work();
    CHECK(f.server.viewers() == 0);
}

TEST_CASE("tile server: whoever asks for more tiles than a viewer would is refused", "[servers]")
{
    Fixture f;
    const std::vector<int32_t> most(4096);
    for (uint64_t group = 0; group < 3; ++group)
    {
        if (group == 0) f.hello("a");
        CHECK(f.server.viewers() == 1);
        f.server.take("a", messageOf(TileOrders{1, group, most, false, {}}));
    }
    CHECK(f.server.viewers() == 0);
    f.hello("a");
    const std::size_t bound = TileServer::kMostQueued;
    for (uint64_t group = 0; group <= bound; ++group) // groups without tiles take memory, too
        f.server.take("a", messageOf(TileOrders{1, group, {}, false, {}}));
    CHECK(f.server.viewers() == 0);
    CHECK(f.kindOfLast() == MessageKind::Refusal);
    CHECK(!f.last<Refusal>().lasts);
}

TEST_CASE("tile server: tiles of passes and scenes that it lacks come back empty", "[servers]")
{
    Fixture f;
    f.hello("a");
    CHECK(!f.server.work());
    f.server.take("a", messageOf(TileOrders{5, 6, {0, 1}, false, {}}));
    CHECK(f.server.work());
    REQUIRE(f.kindOfLast() == MessageKind::Traced);
    CHECK(f.last<TracedTiles>().tiles.empty());
    CHECK(f.last<TracedTiles>().group == 6);

    SceneSender sender;
    f.server.take("a", sceneMessage(3, sender.message(*cornellBox().scene)));
    CHECK(f.kindOfLast() == MessageKind::Ready);
    f.server.take("a", messageOf(boxPass(5, 4))); // another scene
    f.server.take("a", messageOf(boxPass(7, 3)));
    f.server.take("a", messageOf(TileOrders{5, 8, {0, 1}, false, {}}));
    CHECK(f.server.work());
    CHECK(f.last<TracedTiles>().tiles.empty());
    f.server.take("a",
                  messageOf(TileOrders{7, 9, {0, -1, 3, 9, 1 << 30}, false, {}})); // 3 x 3 tiles
    CHECK(f.server.work());
    CHECK(f.last<TracedTiles>().tiles == std::vector<int32_t>{0, 3});
    f.server.take("a", messageOf(TileOrders{7, 10, {0}, false, {}}));
    f.server.take("a", dropMessage(7));
    CHECK(f.server.work());
    CHECK(f.last<TracedTiles>().tiles.empty());
    CHECK(f.last<TracedTiles>().group == 10);
}

TEST_CASE("tile server: viewers take turns, and a damaged message ends one of them", "[servers]")
{
    Fixture f;
    for (const char* viewer : {"a", "b", "c"})
    {
        f.hello(viewer);
        for (uint64_t group = 0; group < 3; ++group)
            f.server.take(viewer, messageOf(TileOrders{group, group, {}, false, {}}));
    }
    f.sent.clear();
    f.server.take("c", Bytes{1, 2, 3});
    CHECK(f.kindOfLast() == MessageKind::Refusal);
    CHECK(f.server.viewers() == 2);
    f.sent.clear();
    while (f.server.work())
        ;
    std::string turns;
    for (const auto& [viewer, message] : f.sent)
        turns += viewer;
    CHECK((turns == "ababab" || turns == "bababa"));
}
