// SharedSceneTest.cpp - ranks that are threads get the scene of rank 0, whatever the network does.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/ThreadGroup.h"

#include "apps/group/SharedRender.h"
#include "apps/group/SharedScene.h"

#include <atomic>
#include <functional>
#include <thread>

using namespace osgRayTrace::app;
using Catch::Matchers::Contains;

namespace
{

SentScene sceneOf(std::mt19937& random)
{
    SentScene scene{640, 480, std::vector<unsigned char>(1 + random() % 5000)};
    for (unsigned char& byte : scene.bytes)
        byte = static_cast<unsigned char>(random());
    return scene;
}

double wallSeconds()
{
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double>(now).count();
}

/// Runs rank 0 and the others, which end as processes do.
void runRanks(int size, unsigned seed, const std::function<void(Group&)>& lead,
              const std::function<void(Group&)>& help)
{
    ThreadNetwork network(size, seed, 500);
    std::vector<std::thread> helpers;
    for (int rank = 1; rank < size; ++rank)
        helpers.emplace_back(
            [&network, &help, rank]
            {
                ThreadGroup group(network, rank);
                help(group);
                waitForBye(group);
            });
    ThreadGroup group(network, 0);
    lead(group);
    sayBye(group);
    for (std::thread& helper : helpers)
        helper.join();
}

} // namespace

TEST_CASE("group: all ranks get the scene of rank 0", "[apps]")
{
    for (const int size : {1, 2, 3, 7})
        for (unsigned seed = 0; seed < 10; ++seed)
        {
            CAPTURE(size, seed);
            std::mt19937 random(seed);
            SentScene scene = sceneOf(random);
            const SentScene sent = scene;
            std::vector<SentScene> got(static_cast<std::size_t>(size));
            int code = -1;
            runRanks(
                size, seed,
                [&](Group& group) { code = sendScene(group, scene, wallSeconds).exitCode; },
                [&](Group& group)
                {
                    if (auto mine = receiveScene(group))
                        got[static_cast<std::size_t>(group.rank())] = *std::move(mine);
                });
            CHECK(code == 0);
            for (int rank = 1; rank < size; ++rank)
            {
                const SentScene& its = got[static_cast<std::size_t>(rank)];
                CHECK((its.bytes == sent.bytes));
                CHECK(its.width == sent.width);
                CHECK(its.height == sent.height);
            }
        }
}

TEST_CASE("group: a rank that cannot take the scene is named, and the others end", "[apps]")
{
    for (unsigned seed = 0; seed < 10; ++seed)
    {
        CAPTURE(seed);
        std::mt19937 random(seed);
        SentScene scene = sceneOf(random);
        SendFailure failure;
        std::atomic<int> without{0};
        runRanks(
            4, seed, [&](Group& group) { failure = sendScene(group, scene, wallSeconds); },
            [&](Group& group)
            {
                if (group.rank() == 2)
                    reportFailure(group, 5, "a reason");
                else if (!receiveScene(group))
                    ++without;
            });
        CHECK(failure.exitCode == 5);
        CHECK_THAT(failure.text, Contains("rank 2 on ") && Contains(": a reason"));
        CHECK(without == 2);
    }
}

TEST_CASE("group: ranks that wait for a scene end with rank 0", "[apps]")
{
    std::atomic<int> without{0};
    runRanks(
        3, 1, [](Group&) {}, // cannot read its model
        [&](Group& group)
        {
            if (!receiveScene(group)) ++without;
        });
    CHECK(without == 2);
}

TEST_CASE("group: a rank without memory for the scene says so", "[apps]")
{
    ThreadNetwork network(2, 1, 0);
    GroupMessage offer(GroupMessage::Kind::Scene);
    offer.bytes = ~std::uint64_t(0); // no vector holds as many: sanitizers are not asked for them
    ThreadGroup zero(network, 0), one(network, 1);
    zero.send(1, offer);
    CHECK_THROWS_WITH(receiveScene(one), Contains("there is not enough memory for the scene"));
}

TEST_CASE("group: a rank that does not answer is named before the scene is sent", "[apps]")
{
    ThreadNetwork network(3, 1, 0);
    ThreadGroup zero(network, 0), one(network, 1);
    one.send(0, GroupMessage(GroupMessage::Kind::Room));
    std::mt19937 random(1);
    SentScene scene = sceneOf(random);
    double now = 0.0;
    const SendFailure failure = sendScene(zero, scene, [&now] { return now += 10.0; });
    CHECK(failure.exitCode == 3);
    CHECK_THAT(failure.text, Contains("rank 2 does not answer"));
}
