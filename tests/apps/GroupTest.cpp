// GroupTest.cpp - ranks that are threads make a picture together, whatever the network does.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/ThreadCluster.h"

#include <cmath>

using namespace osgRayTrace::app;
using Catch::Matchers::Contains;
using osgRayTrace::engine::PassSet;
using osgRayTrace::engine::passSetOf;

namespace
{

GroupPlan planOf(int passes)
{
    GroupPlan plan;
    plan.endPass = passes;
    return plan;
}

} // namespace

TEST_CASE("group: ranks of any number and speed make each pass once", "[apps]")
{
    for (const int size : {1, 2, 3, 7})
        for (unsigned seed = 0; seed < 6; ++seed)
        {
            CAPTURE(size, seed);
            std::mt19937 random(seed);
            ThreadCluster cluster;
            cluster.plan = planOf(static_cast<int>(random() % 60));
            cluster.plan.interval = seed % 2 ? 0.003 : 0.0;
            cluster.seed = seed;
            cluster.ranks.resize(static_cast<std::size_t>(size));
            for (Rank& rank : cluster.ranks)
            {
                rank.microseconds = static_cast<int>(random() % 800);
                rank.learning = seed % 3 == 0 ? 16 : 0;
            }
            const GroupResult result = cluster.run();
            CHECK(result.exitCode == 0);
            CHECK(result.failure == "");
            const int made = cluster.allMade();
            CHECK(made == cluster.plan.endPass);
            CHECK(result.rays[0] == static_cast<std::uint64_t>(made));
            if (made == 0) CHECK_FALSE(result.sums);
            if (made == 0) continue;
            REQUIRE(result.sums);
            CHECK(areEqual(*result.sums, sumsOf(PassSet(made))));
            CHECK(cluster.sumsAreRight);
        }
}

TEST_CASE("group: sums that fill their integers are added without overflow", "[apps]")
{
    // Ranks have sums of about 2^60, in normal form, and all of them together 2^63.
    const std::int64_t scale = (std::int64_t(1) << 28) + 12345;
    ThreadCluster cluster;
    cluster.plan = planOf(40);
    cluster.ranks.resize(7);
    for (Rank& rank : cluster.ranks)
    {
        rank.scale = scale;
        rank.microseconds = 2000;
    }
    const GroupResult result = cluster.run();
    REQUIRE(result.sums);
    CHECK(areEqual(*result.sums, sumsOf(PassSet(40), scale)));
}

TEST_CASE("group: a render goes on from the passes that are there", "[apps]")
{
    ThreadCluster cluster;
    cluster.plan = planOf(40);
    cluster.plan.base = sumsOf(*passSetOf("2-7,12,20-24"));
    cluster.plan.basePicture = Rank().picture;
    cluster.ranks.resize(3);
    GroupResult result = cluster.run();
    REQUIRE(result.sums);
    CHECK(areEqual(*result.sums, sumsOf(PassSet(40))));
    CHECK(result.rays[0] == 40 - 12);

    // Nothing is left to do.
    cluster.plan.base = sumsOf(PassSet(40));
    result = cluster.run();
    REQUIRE(result.sums);
    CHECK(areEqual(*result.sums, sumsOf(PassSet(40))));
    CHECK(result.rays[0] == 0);

    cluster.plan.basePicture = "seed 1\nsize 5 3\n";
    result = cluster.run();
    CHECK(result.exitCode == 3);
    CHECK_THAT(result.failure, Contains("seed 1, and seed 0"));
}

TEST_CASE("group: the pass that an error target ends with does not depend on ranks", "[apps]")
{
    for (const int size : {1, 2, 7})
        for (const int begun : {0, 5, 16, 23})
        {
            CAPTURE(size, begun);
            ThreadCluster cluster;
            cluster.plan = planOf(1 << 24);
            cluster.plan.relativeError = 0.2;
            cluster.seed = static_cast<unsigned>(size);
            cluster.error = [](int passes) { return 1.0 / std::sqrt(double(passes)); };
            cluster.ranks.resize(static_cast<std::size_t>(size));
            for (Rank& rank : cluster.ranks)
                rank.microseconds = 100;
            if (begun > 0) cluster.plan.base = sumsOf(PassSet(begun));
            cluster.plan.basePicture = Rank().picture;
            const GroupResult result = cluster.run();
            REQUIRE(result.sums);
            CHECK(areEqual(*result.sums, sumsOf(PassSet(27)))); // 25 passes; 27 are on the grid
            CHECK(cluster.cancelled);
        }

    // A file that has reached its target is done.
    ThreadCluster cluster;
    cluster.plan = planOf(1 << 24);
    cluster.plan.relativeError = 0.5;
    cluster.plan.base = sumsOf(PassSet(8));
    cluster.plan.basePicture = Rank().picture;
    cluster.error = [](int passes) { return passes < 8 ? 1.0 : 0.4; };
    cluster.ranks.resize(2);
    const GroupResult result = cluster.run();
    REQUIRE(result.sums);
    CHECK(result.sums->passes == PassSet(8));
}

TEST_CASE("group: time ends a render with whole leases, in order", "[apps]")
{
    ThreadCluster cluster;
    cluster.plan = planOf(1 << 24);
    cluster.plan.seconds = 0.05;
    cluster.ranks.resize(3);
    for (Rank& rank : cluster.ranks)
        rank.microseconds = 300;
    const GroupResult result = cluster.run();
    REQUIRE(result.sums);
    const int passes = result.sums->passes.count();
    CHECK(passes >= 1);
    CHECK(areEqual(*result.sums, sumsOf(PassSet(passes))));
}

TEST_CASE("group: a signal to any rank ends the render, and no pass is lost", "[apps]")
{
    for (unsigned seed = 0; seed < 6; ++seed)
    {
        CAPTURE(seed);
        ThreadCluster cluster;
        cluster.plan = planOf(1 << 24);
        cluster.seed = seed;
        cluster.ranks.resize(3);
        for (Rank& rank : cluster.ranks)
        {
            rank.microseconds = 200;
            rank.learning = seed % 2 ? 16 : 0;
        }
        cluster.clockRate = 0.05; // a busy machine is not a dead one
        cluster.interruptedRank = static_cast<int>(seed % 3);
        cluster.interruptedAtPass = static_cast<int>(7 * seed);
        const GroupResult result = cluster.run();
        CHECK(result.exitCode == 0);
        const int made = cluster.allMade();
        REQUIRE(bool(result.sums) == (made > 0));
        if (!result.sums) continue;
        CHECK(result.sums->passes.count() == made);
        CHECK(areEqual(*result.sums, sumsOf(result.sums->passes)));
    }
}

TEST_CASE("group: the depths are those of the least pass, whichever rank has it", "[apps]")
{
    // Rank 0 still learns for the first pass when the signal comes, and makes none.
    ThreadCluster cluster;
    cluster.plan = planOf(1 << 24);
    cluster.plan.firstPass = 1 << 20;
    cluster.clockRate = 0.05; // a busy machine is not a dead one
    cluster.ranks.resize(3);
    for (Rank& rank : cluster.ranks)
        rank.microseconds = 200;
    cluster.ranks[0].learning = 1 << 20;
    cluster.interruptedRank = 1;
    cluster.interruptedAtPass = (1 << 20) + 4;
    const GroupResult result = cluster.run();
    CHECK(result.exitCode == 0);
    CHECK(cluster.made[0] == 0);
    REQUIRE(result.sums);
    CHECK(result.sums->depth[0] >= float(1 << 20));
    CHECK(areEqual(*result.sums, sumsOf(result.sums->passes)));
}

TEST_CASE("group: a rank with another picture is named, and so is what differs", "[apps]")
{
    ThreadCluster cluster;
    cluster.plan = planOf(8);
    cluster.ranks.resize(4);
    cluster.ranks[2].host = "n2";
    cluster.ranks[2].picture = "seed 0\nsize 5 4\n";
    const GroupResult result = cluster.run();
    CHECK(result.exitCode == 3);
    CHECK_THAT(result.failure, Contains("rank 2 on n2") && Contains("size 5 4 there, size 5 3 on"));
    CHECK_FALSE(result.sums);
    CHECK(cluster.made == std::vector<int>(4, 0));
}

TEST_CASE("group: a rank that fails ends the render, and is named", "[apps]")
{
    for (const int failing : {0, 2})
    {
        ThreadCluster cluster;
        cluster.plan = planOf(100);
        cluster.ranks.resize(3);
        Rank& rank = cluster.ranks[static_cast<std::size_t>(failing)];
        rank.host = "n2";
        rank.failsAtPass = 3;
        for (Rank& each : cluster.ranks)
            each.microseconds = 100;
        const GroupResult result = cluster.run();
        CHECK(result.exitCode == 3);
        CHECK_THAT(result.failure,
                   Contains("rank " + std::to_string(failing) + " on n2: a reason"));
    }
}

TEST_CASE("group: a rank that says nothing any more ends the group", "[apps]")
{
    ThreadCluster cluster;
    cluster.plan = planOf(1 << 24);
    cluster.ranks.resize(3);
    cluster.ranks[2].failsAtPass = 4;
    cluster.ranks[2].diesSilently = true;
    for (Rank& rank : cluster.ranks)
        rank.microseconds = 100;
    cluster.clockRate = 300.0; // a minute is 0.2 s
    const GroupResult result = cluster.run();
    CHECK(result.failure == "aborted");
    CHECK(result.exitCode == 3);
}

TEST_CASE("group: a rank that is dead when a signal comes ends the group at once", "[apps]")
{
    ThreadCluster cluster;
    cluster.plan = planOf(1 << 24);
    cluster.ranks.resize(3);
    cluster.ranks[1].failsAtPass = 4;
    cluster.ranks[1].diesSilently = true;
    for (Rank& rank : cluster.ranks)
        rank.microseconds = 1000;
    cluster.interruptedRank = 0;
    cluster.interruptedAtPass = 40;
    const auto begin = std::chrono::steady_clock::now();
    const GroupResult result = cluster.run();
    CHECK(result.failure == "aborted");
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(30)); // not a minute
}

TEST_CASE("group: sums are kept once in an interval, and each keeps all passes before it", "[apps]")
{
    ThreadCluster cluster;
    cluster.plan = planOf(300);
    cluster.plan.interval = 0.005;
    cluster.ranks.resize(3);
    for (Rank& rank : cluster.ranks)
        rank.microseconds = 300;
    const GroupResult result = cluster.run();
    REQUIRE(result.sums);
    CHECK(result.sums->passes == PassSet(300));
    REQUIRE(cluster.kept.size() > 1);
    for (const PassSet& kept : cluster.kept)
        CHECK(kept.ranges().size() == 1); // without holes
}
