// ServerFaultsTest.cpp - what servers get wrong, step by step: no thread, no clock of the machine.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/servers/ServerMessages.h"
#include "osgRayTrace/servers/ServerPool.h"
#include "osgRayTrace/servers/TileServer.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

bool isOf(MessageKind kind, const Bytes& message)
{
    return message[0] == static_cast<uint8_t>(kind);
}

/// What happens on a line to a server.
struct Line
{
    std::function<bool(Bytes&)> toServer = [](Bytes&) { return true; }; ///< false: is lost
    std::function<bool(Bytes&)> toViewer = [](Bytes&) { return true; }; ///< false: comes later
    std::vector<MessageKind> sent;                                      ///< by the viewer

    std::ptrdiff_t count(MessageKind kind) const
    {
        return std::count(sent.begin(), sent.end(), kind);
    }
};

/// A server in the link itself, which works when it is listened to.
class DirectLink : public Link
{
public:
    explicit DirectLink(Line& line) : _line(line) {}
    bool send(const Bytes& message) override
    {
        Bytes copy = message;
        _line.sent.push_back(static_cast<MessageKind>(message[0]));
        if (_line.toServer(copy)) _server.take("viewer", copy);
        return true;
    }
    bool receive(Bytes& message) override
    {
        while (_server.work())
            ;
        if (_answers.empty() || !_line.toViewer(_answers.front())) return false;
        message = std::move(_answers.front());
        _answers.pop_front();
        return true;
    }

private:
    Line& _line;
    std::deque<Bytes> _answers;
    TileServer _server{std::make_shared<Workers>(1),
                       [this](const std::string&, Bytes&& message)
                       { _answers.push_back(std::move(message)); },
                       [] { return 0.0; }};
};

/// A pool of one server, and a pass of 6 x 6 tiles for it.
struct Fixture
{
    double seconds = 0.0;
    Line line;
    ServerPool pool{[this] { return seconds; }};
    HelpedPass pass;
    int next = 0, brought = 0;
    SharedTiles tiles;

    explicit Fixture(bool isReached = true)
    {
        if (!isReached) line.toServer = [](Bytes&) { return false; };
        pass.scene = cornellBox().build(1);
        pass.view = cornellView(48, 48);
        pass.options = optionsOf(IntegratorKind::Whitted);
        pass.wantsDepth = true;
        tiles.take = [this] { return next < 36 ? next++ : -1; };
        tiles.left = [this] { return 36 - next; };
        tiles.bring = [this](int, const TracedTile&) { ++brought; };
        pool.add("server", std::make_unique<DirectLink>(line));
    }
    std::unique_ptr<PassHelp> begin()
    {
        for (int i = 0; i < 3; ++i)
            if (std::unique_ptr<PassHelp> help = pool.begin(pass, tiles)) return help;
        return nullptr;
    }
    /// Returns the tiles that are late in a few steps, which take no time.
    static std::size_t late(PassHelp& help)
    {
        std::size_t count = 0;
        for (int i = 0; i < 4; ++i)
        {
            help.exchange();
            count += help.takeLate().size();
        }
        return count;
    }
};

} // namespace

TEST_CASE("server faults: nobody waits for the other tiles of a server that sends damaged ones",
          "[servers]")
{
    Fixture f;
    int answers = 0;
    f.line.toViewer = [&](Bytes& message)
    {
        if (!isOf(MessageKind::Traced, message)) return true;
        if (++answers > 1) return false;
        message.resize(message.size() / 2);
        return true;
    };
    const auto help = f.begin();
    REQUIRE(help);
    help->exchange(); // gives two tiles, one by one
    REQUIRE(help->awaited() == 2);
    const std::size_t late = Fixture::late(*help);
    CHECK(late == static_cast<std::size_t>(f.next)); // what was given meanwhile, too
    CHECK(f.brought == 0);
    CHECK(help->awaited() == 0);
    CHECK(f.pool.serversIn() == 0);
    CHECK(f.pool.takeNotes().size() == 1);
}

TEST_CASE("server faults: one that has forgotten a pass is not refused", "[servers]")
{
    Fixture f;
    f.line.toServer = [](Bytes& message) { return !isOf(MessageKind::Pass, message); };
    const auto help = f.begin();
    REQUIRE(help);
    CHECK(Fixture::late(*help) > 0);
    CHECK(f.brought == 0);
    CHECK(f.pool.serversIn() == 1);
    CHECK(f.pool.takeNotes().empty());
}

TEST_CASE("server faults: one that is busy for long keeps its scene", "[servers]")
{
    Fixture f;
    bool isBusy = true;
    f.line.toViewer = [&](Bytes& message)
    { return !isBusy || !isOf(MessageKind::Traced, message); };
    auto help = f.begin();
    REQUIRE(help);
    help->exchange();
    f.seconds = 3.0;
    CHECK(Fixture::late(*help) == 2);
    CHECK(help->awaited() == 0);
    CHECK(f.pool.serversIn() == 0);
    CHECK(f.pool.takeNotes() == std::vector<std::string>{"server server does not answer: the "
                                                         "others trace its tiles"});
    help.reset();
    CHECK(!f.begin());
    isBusy = false;
    help = f.begin();
    REQUIRE(help);
    Fixture::late(*help);
    CHECK(f.brought > 0);
    CHECK(f.line.count(MessageKind::Hello) == 1);
    CHECK(f.line.count(MessageKind::Scene) == 1);
}

TEST_CASE("server faults: while a large scene is prepared, silence is none", "[servers]")
{
    Fixture f;
    auto help = f.begin();
    REQUIRE(help);
    help->exchange(); // gives tiles of the small scene
    REQUIRE(help->awaited() == 2);
    bool isBusy = true;
    f.line.toViewer = [&](Bytes&) { return !isBusy; };
    SceneBuilder builder = cornellBox();
    builder.add(sphereMesh(Vec3(200, 100, 200), 50.0f, 180), lambert(Vec3(0.5f)));
    HelpedPass large = f.pass;
    large.scene = builder.build(1);
    f.pool.begin(large, f.tiles);
    f.seconds = 10.0;
    CHECK(Fixture::late(*help) == 2);
    CHECK(f.pool.serversIn() == 1);
    isBusy = false;
    f.pool.begin(large, f.tiles);
    CHECK(f.pool.takeNotes().empty());
    CHECK(f.line.count(MessageKind::Scene) == 2);
}

TEST_CASE("server faults: refusals for passing reasons are asked again, those of other builds not",
          "[servers]")
{
    for (const bool lasts : {false, true})
    {
        CAPTURE(lasts);
        Fixture f;
        bool refuses = true;
        f.line.toViewer = [&](Bytes& message)
        {
            if (refuses) message = messageOf(Refusal{"no memory", lasts});
            refuses = false;
            return true;
        };
        f.begin();
        CHECK(f.pool.takeNotes() ==
              std::vector<std::string>{"server server does not help: no memory"});
        f.seconds = 20.0;
        CHECK(!f.begin());
        f.seconds = 40.0;
        CHECK((f.begin() != nullptr) == !lasts);
    }
}

TEST_CASE("server faults: one that is never reached is mentioned, once", "[servers]")
{
    Fixture f(false);
    CHECK(!f.begin());
    CHECK(f.pool.takeNotes().empty());
    for (const double seconds : {11.0, 30.0})
    {
        f.seconds = seconds;
        CHECK(!f.begin());
    }
    CHECK(f.pool.takeNotes().size() == 1);
}

TEST_CASE("server faults: times that a server tells are at most those that it had", "[servers]")
{
    Line line;
    RemoteServer server("server", std::make_unique<DirectLink>(line));
    for (const double told : {1e9, 1e-300})
    {
        PassOrder order;
        RemoteServer::Group group;
        group.tiles = {0, 1};
        group.sent = 10.0;
        REQUIRE(server.sendTiles(order, group, {}));
        TracedTiles head;
        head.seconds = told;
        REQUIRE(server.takeGroup(head, 70.0));
        CHECK(server.speed() > 0.03); // two tiles in a minute
        CHECK(server.speed() < 1e8);
        group.sent = 70.0;
        REQUIRE(server.sendTiles(order, group, {}));
        CHECK(server.lateAfter(group) <= 71.0); // whatever the means are
        REQUIRE(server.takeGroup(TracedTiles(), 70.0));
    }
}
