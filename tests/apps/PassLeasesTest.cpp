// PassLeasesTest.cpp - who makes which passes, what ranks say, and where they run.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "apps/group/GroupMessage.h"
#include "apps/group/Launcher.h"
#include "apps/group/PassLeases.h"

#include <functional>
#include <numeric>
#include <queue>
#include <random>

using namespace osgRayTrace::app;
using Catch::Matchers::Contains;
using osgRayTrace::engine::PassSet;
using osgRayTrace::engine::passSetOf;

namespace
{

/// Ranks of different speeds make passes until none is left.
struct Race
{
    int ranks;
    double ideal;          ///< time that all ranks together take at best [s]
    double secondsPerPass; ///< of a rank of speed 1
    bool isStatic = false; ///< each rank has its share from the begin

    /// Returns the ideal time over the time of the race.
    double efficiency() const
    {
        constexpr double kAnswer = 0.004; ///< a look of rank 0, and the network [s]
        std::mt19937 random(3);
        std::vector<double> speeds;
        for (int i = 0; i < ranks; ++i)
            speeds.push_back(0.95 + 0.1 * std::generate_canonical<double, 32>(random));
        speeds.back() = 0.5;
        const double all = std::accumulate(speeds.begin(), speeds.end(), 0.0);
        const int passes = static_cast<int>(ideal * all / secondsPerPass);
        if (isStatic) return ideal * speeds.back() / (passes / ranks * secondsPerPass);

        PassLeases leases(PassSet(), 0, passes, ranks);
        using Event = std::pair<double, int>; // when a rank is done
        std::priority_queue<Event, std::vector<Event>, std::greater<Event>> events;
        for (int i = 0; i < ranks; ++i)
            events.push({0.0, i});
        double end = 0.0;
        for (; !events.empty(); events.pop())
        {
            const auto [now, rank] = events.top();
            const auto lease = leases.take(rank, passes, 1e9);
            if (!lease) continue;
            const int count = lease->second - lease->first;
            const double seconds = count * secondsPerPass / speeds[std::size_t(rank)];
            leases.finish(rank, count, seconds);
            end = std::max(end, now + seconds);
            events.push({now + seconds + kAnswer, rank});
        }
        return ideal / end;
    }
};

} // namespace

TEST_CASE("group: ranks end together, though one has half the speed", "[apps]")
{
    const double quick = 0.036, slow = 0.58,
                 photons = 3.0; // a pass of 1920 x 1080 on 64, 4, 4 cores
    for (const double seconds : {quick, slow})
    {
        CAPTURE(seconds);
        CHECK(Race{16, 60.0, seconds}.efficiency() >= 0.95);
        CHECK(Race{256, 60.0, seconds}.efficiency() >= 0.95);
        CHECK(Race{256, 600.0, seconds}.efficiency() >= 0.99);
        CHECK(Race{1024, 60.0, seconds}.efficiency() >= 0.95);
    }
    CHECK(Race{1024, 60.0, photons}.efficiency() >= 0.94);
    CHECK(Race{1024, 600.0, slow}.efficiency() >= 0.99);
    CHECK(Race{256, 60.0, slow, true}.efficiency() <= 0.55);
}

TEST_CASE("group: the grid of an error target has four points in an octave", "[apps]")
{
    std::vector<int> points;
    for (int point = nextGridPoint(0); point <= 128; point = nextGridPoint(point))
        points.push_back(point);
    CHECK(points ==
          std::vector<int>{2, 4, 8, 16, 19, 23, 27, 32, 38, 45, 54, 64, 76, 91, 108, 128});
    CHECK(nextGridPoint(1 << 24) > 1 << 24);
}

TEST_CASE("group: leases fit a rank's speed and the rest of the work", "[apps]")
{
    constexpr double kLong = 1e9;
    PassLeases leases(*passSetOf("3-4"), 0, 10000, 2);
    CHECK(leases.take(0, 10000, kLong) == PassSet::Range(0, 1)); // speed unknown
    leases.finish(0, 1, 0.01);
    CHECK(leases.take(0, 10000, kLong) == PassSet::Range(1, 3)); // to what is there
    CHECK(leases.take(0, 10000, kLong) == PassSet::Range(5, 9)); // four times as many
    leases.finish(0, 100, 1.0);
    CHECK(leases.take(0, 10000, kLong) == PassSet::Range(9, 209)); // two seconds
    CHECK(leases.take(0, 10000, 4.0) == PassSet::Range(209, 309)); // a quarter of what is left
    CHECK(leases.take(0, 400, kLong) == PassSet::Range(309, 400));
    CHECK_FALSE(leases.take(0, 400, kLong));
    CHECK(leases.take(0, 10000, -1.0) == PassSet::Range(400, 401));
    CHECK(leases.take(1, 10000, kLong) == PassSet::Range(401, 402)); // another rank
    leases.finish(0, 2000, 1e-3);
    CHECK(leases.take(0, 10000, kLong) == PassSet::Range(402, 402 + (10000 - 402) / 8));
    for (int first = leases.firstLeft(); first < 10000; first = leases.firstLeft())
    {
        const auto lease = leases.take(0, 10000, kLong);
        REQUIRE(lease);
        CHECK(lease->first == first);
        CHECK(lease->second - first <= std::max(1, (10000 - first) / 8));
    }
    CHECK(leases.firstLeft() == 10000);
}

TEST_CASE("group: messages of wrong sizes are none", "[apps]")
{
    GroupMessage message(GroupMessage::Kind::Ready);
    message.first = -3;
    message.text = "0-7";
    message.host = "n1";
    message.rays = {1, 2, 3, 4, 1ull << 63};
    message.processors = {1, 2, 3};
    const std::vector<char> bytes = packed(message);
    const auto read = unpacked(bytes);
    REQUIRE(read);
    CHECK(packed(*read) == bytes);
    CHECK((read->text == "0-7" && read->host == "n1" && read->first == -3));
    for (std::size_t size = 0; size < bytes.size(); ++size)
        CHECK_FALSE(
            unpacked(std::vector<char>(bytes.begin(), bytes.begin() + std::ptrdiff_t(size))));
    std::vector<char> more = bytes;
    more.push_back('x');
    CHECK_FALSE(unpacked(more));
}

TEST_CASE("group: a binding to one core each is named if there are more", "[apps]")
{
    const RankPlace bound{"n4", {1, 1, 64}}, smt{"n4", {2, 2, 64}}, whole{"n4", {64, 2, 64}};
    CHECK_THAT(bindingNote({bound, bound}), Contains("each rank on n4 may use 1 of 64 processors"));
    CHECK_THAT(bindingNote({smt}), Contains("2 of 64"));
    CHECK(bindingNote({whole, bound}) == "");
    CHECK(bindingNote({{"a", {1, 1, 2}}, {"a", {1, 1, 2}}}) == ""); // each has its core
    CHECK(bindingNote({{"a", {1, 1, 1}}}) == "");

    CHECK(threadsOf({64, 2, 64}, 1) == 64);
    CHECK(threadsOf({64, 2, 64}, 2) == 32);
    CHECK(threadsOf({16, 2, 64}, 4) == 16);
    CHECK(threadsOf({2, 1, 2}, 7) == 1);
}
