// ServerTimesTest.cpp - how long a dead server delays frames, and how soon its successor helps, in
// time that the test counts.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/servers/ServerMessages.h"
#include "osgRayTrace/servers/ServerPool.h"

#include <algorithm>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr double kTile = 2e-4;     ///< time of a tile, on the viewer and on each server [s]
constexpr double kWay = 2e-4;      ///< time of a message [s]
constexpr double kBuild = 0.02;    ///< time in which a server prepares a scene [s]
constexpr double kReconnect = 0.1; ///< time until a line to a new process is there [s]
constexpr double kBudget = 0.033;  ///< of a frame [s]
constexpr int kTiles = 300;

/// A server that traces nothing but takes the time for it.
struct SlowServer
{
    double now = 0.0;
    double freeAt = 0.0;
    double reachedFrom = 0.0; ///< when the line is there
    bool isDead = false;
    bool isTold = true; ///< whether the viewer's machine learns that the process is gone
    bool isKnown = false;
    std::deque<std::pair<double, Bytes>> answers;

    bool isReached() const { return !isDead && now >= reachedFrom; }

    void die()
    {
        isDead = true;
        isKnown = false;
        answers.clear();
    }
    void comeBack()
    {
        isDead = false;
        reachedFrom = now + kReconnect;
        freeAt = 0.0;
    }
    void answer(Bytes&& message, double seconds)
    {
        freeAt = std::max(freeAt, now + kWay) + seconds;
        answers.emplace_back(freeAt + kWay, std::move(message));
    }
    void take(const Bytes& message)
    {
        WireReader in(message);
        MessageKind kind{};
        takeKind(in, kind);
        if (kind == MessageKind::Hello)
        {
            Hello hello;
            uint64_t magic = 0;
            in(magic, hello.number);
            isKnown = true;
            return answer(messageOf(Welcome{hello.number, 1}), 0.0);
        }
        if (!isKnown) return answer(plainMessage(MessageKind::Stranger), 0.0);
        if (kind == MessageKind::Scene)
        {
            uint64_t number = 0;
            in(number);
            return answer(messageOf(Ready{number, kBuild}), kBuild);
        }
        if (kind != MessageKind::Tiles) return;
        TileOrders orders;
        takeMessage(in, orders, kTiles);
        TracedTiles traced;
        traced.pass = orders.pass;
        traced.group = orders.group;
        traced.tiles = orders.tiles;
        traced.seconds = kTile * double(orders.tiles.size());
        const std::vector<TracedTile> results(orders.tiles.size());
        answer(messageOf(traced, results.data()), traced.seconds);
    }
};

class SlowLink : public Link
{
public:
    explicit SlowLink(SlowServer& server) : _server(server) {}
    bool send(const Bytes& message) override
    {
        if (_server.isReached()) _server.take(message);
        return _server.isReached() || !_server.isTold;
    }
    bool receive(Bytes& message) override
    {
        if (_server.answers.empty() || _server.answers.front().first > _server.now) return false;
        message = std::move(_server.answers.front().second);
        _server.answers.pop_front();
        return true;
    }

private:
    SlowServer& _server;
};

/// A viewer of one thread with two servers, all of the same speed.
struct Viewer
{
    double now = 0.0;
    SlowServer first, second;
    ServerPool pool{[this] { return now; }};
    HelpedPass pass;
    int next = 0, done = 0;
    SharedTiles tiles;

    explicit Viewer(bool isTold)
    {
        second.isTold = isTold;
        pass.scene = cornellBox().build(1);
        pass.view = cornellView(48, 48);
        pass.options = optionsOf(IntegratorKind::Whitted);
        tiles.take = [this] { return next < kTiles ? next++ : -1; };
        tiles.left = [this] { return kTiles - next; };
        tiles.bring = [this](int, const TracedTile&) { ++done; };
        pool.add("first", std::make_unique<SlowLink>(first));
        pool.add("second", std::make_unique<SlowLink>(second));
    }

    void wait(double seconds)
    {
        now += seconds;
        first.now = second.now = now;
    }

    /// Traces a frame as a session does. Returns the time that it takes.
    double frame()
    {
        const double begin = now;
        next = done = 0;
        const std::unique_ptr<PassHelp> help = pool.begin(pass, tiles);
        while (done < kTiles)
        {
            if (help) help->exchange();
            int own = tiles.take() >= 0 ? 1 : 0;
            if (own == 0 && help && done < kTiles) own = int(help->takeLate().size());
            done += own;
            wait(own > 0 ? own * kTile : 5e-5);
        }
        return now - begin;
    }

    /// Returns the longest of some frames.
    double longestOf(int frames)
    {
        double longest = 0.0;
        for (int i = 0; i < frames; ++i)
            longest = std::max(longest, frame());
        return longest;
    }
};

constexpr double kOfThree = kTiles * kTile / 3, kOfTwo = kTiles * kTile / 2;

} // namespace

TEST_CASE("server times: a dead one makes one frame late, by less than a budget", "[servers]")
{
    double latest = 0.0;
    for (const bool isTold : {true, false})
        for (int turn = 0; turn < 10; ++turn)
        {
            CAPTURE(isTold, turn);
            Viewer viewer(isTold);
            viewer.longestOf(20);
            REQUIRE(viewer.longestOf(5) < 1.2 * kOfThree);
            // The server dies at some time within a frame.
            const auto bring = viewer.tiles.bring;
            viewer.tiles.bring = [&](int tile, const TracedTile& traced)
            {
                bring(tile, traced);
                if (viewer.done > turn * kTiles / 10) viewer.second.die();
            };
            const double late = viewer.frame();
            viewer.tiles.bring = bring;
            viewer.second.die();
            const double next = viewer.frame();
            latest = std::max(latest, std::max(late, next) - kOfTwo);
            CHECK(std::min(late, next) < 1.2 * kOfTwo);
            CHECK(viewer.longestOf(100) < 1.2 * kOfTwo); // for some 3 s
        }
    INFO("the latest frame is late by " << latest << " s");
    CHECK(latest < kBudget);
}

TEST_CASE("server times: one that comes back has its share within a second", "[servers]")
{
    double longest = 0.0;
    for (const bool isTold : {true, false})
        for (int turn = 0; turn < 40; ++turn)
        {
            CAPTURE(isTold, turn);
            Viewer viewer(isTold);
            viewer.longestOf(20);
            viewer.second.die();
            viewer.longestOf(20 + 3 * turn);
            viewer.second.comeBack();
            const double begin = viewer.now;
            while (viewer.frame() > 1.2 * kOfThree && viewer.now - begin < 10.0)
            {
            }
            longest = std::max(longest, viewer.now - begin);
        }
    INFO("the longest time is " << longest << " s");
    CHECK(longest < 1.0);
    CHECK(longest > kReconnect + kBuild);
}
