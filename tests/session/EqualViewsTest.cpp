// EqualViewsTest.cpp - the walls of a CAVE under one frame budget: their costs differ, their
// pictures do not.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/session/WalledCave.h"

#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/session/view/ViewTracer.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <thread>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("equal views: without agreement walls of different cost differ, with it never",
          "[session]")
{
    int differing = 0;
    for (const bool equal : {false, true})
    {
        Cave cave({0.2, 5.0});
        double x = 0.0;
        for (int i = 0; i < 60; ++i)
        {
            if (i < 25 || i > 50) x += 1.0;
            const std::vector<WallPicture> pictures = cave.frame(x, equal);
            CAPTURE(i, pictures[0].divider, pictures[1].divider, pictures[0].passes,
                    pictures[1].passes);
            if (equal) REQUIRE(allSame(pictures));
            if (!equal) differing += !allSame(pictures);
        }
    }
    CHECK(differing > 20);
}

TEST_CASE("equal views: two and four walls of any cost agree in each frame, in the time of one",
          "[session]")
{
    for (const std::vector<double>& costs :
         {std::vector<double>{1.0, 1.0}, std::vector<double>{0.01, 6.0},
          std::vector<double>{0.3, 0.1, 2.0, 0.02}})
    {
        Cave cave(costs);
        std::mt19937 random(3);
        double x = 0.0, movedSeconds = 0.0;
        int atRest = 0;
        for (int i = 0; i < 150; ++i)
        {
            const bool moves = i % 50 < 25 || random() % 12 == 0;
            x += moves;
            const std::vector<WallPicture> pictures = cave.frame(x);
            CAPTURE(i, costs.size(), pictures[0].divider, pictures[0].passes, cave.seconds);
            REQUIRE(allSame(pictures));
            if (i > 3) CHECK(cave.seconds < 1.1 * kBudget);
            if (i > 20 && i < 25) movedSeconds += cave.seconds / 4.0;
            atRest += !moves && pictures[0].divider == 1 && pictures[0].passes > 0;
        }
        CHECK(movedSeconds > 0.4 * kBudget); // the next divider may take four times as long
        CHECK(atRest > 20);
    }
}

TEST_CASE(
    "equal views: at rest all walls complete each pass in the same frame, though it takes several",
    "[session]")
{
    Cave cave({0.5, 8.0, 3.0}); // a pass takes 920, the budget is 250
    for (int i = 0; i < 15; ++i)
        cave.frame(i);
    int last = 0, completed = 0, frames = 0;
    for (; frames < 200 && last < kMaxPasses; ++frames)
    {
        const std::vector<WallPicture> pictures = cave.frame(14.0);
        CAPTURE(frames, pictures[0].passes, pictures[1].passes, pictures[2].passes);
        REQUIRE(allSame(pictures));
        CHECK(cave.seconds < 1.1 * kBudget);
        const int passes = pictures[0].divider == 1 ? pictures[0].passes : 0;
        completed += passes > last;
        last = std::max(last, passes);
    }
    CHECK(completed == kMaxPasses);
    CHECK(frames > 12);
    for (int wall = 0; wall < 3; ++wall)
        CHECK(cave.walls[std::size_t(wall)]->rgba ==
              reference(cave, wall, 14.0, {1, kMaxPasses, kWidth}));
    const double clock = cave.clock;
    cave.frame(14.0);
    CHECK(cave.clock == clock); // all passes are done: no tile is traced
}

TEST_CASE("equal views: across the edge both walls show pictures of the same resolution and passes",
          "[session]")
{
    Cave cave({0.05, 4.0});
    std::vector<WallPicture> pictures;
    for (int i = 0; i < 12; ++i)
        pictures = cave.frame(i);
    REQUIRE(pictures[0].divider > 1);
    for (int wall = 0; wall < 2; ++wall)
        CHECK(cave.walls[std::size_t(wall)]->rgba == reference(cave, wall, 11.0, pictures[0]));
}

TEST_CASE(
    "equal views: a wall that comes is coarse once and then as the others, one that goes gives "
    "its time to them",
    "[session]")
{
    Cave cave({0.05, 0.05});
    for (int i = 0; i < 10; ++i)
        cave.frame(i);
    const WallPicture before = cave.frame(10.0)[0];
    CHECK(before.divider == 1);

    cave.add(20.0);
    const std::vector<WallPicture> first = cave.frame(11.0);
    CHECK(first[2].divider == FramePlanner::kFirstDivider);
    CHECK(first[2].passes == 1);
    for (int i = 12; i < 30; ++i)
    {
        CAPTURE(i);
        const std::vector<WallPicture> pictures = cave.frame(i);
        REQUIRE(allSame(pictures));
        CHECK(pictures[0].divider > 1);
        CHECK(cave.seconds < 1.1 * kBudget);
    }

    SECTION("destroyed")
    {
        cave.walls.pop_back();
    }
    SECTION("no longer drawn")
    {
        const auto hidden = std::move(cave.walls.back());
        cave.walls.pop_back();
        for (int i = 30; i < 60; ++i)
            REQUIRE(allSame(cave.frame(i)));
        CHECK(cave.frame(60.0)[0].divider == 1);
    }
    for (int i = 61; i < 90; ++i)
        REQUIRE(allSame(cave.frame(i)));
    CHECK(cave.frame(90.0)[0].divider == 1);
}

TEST_CASE("equal views: one that moves beside one at rest: both within the time of all",
          "[session]")
{
    Cave cave({3.0, 3.0});
    for (int i = 0; i < 10; ++i)
        cave.frame(i);
    int last = 0;
    for (int i = 10; i < 60; ++i)
    {
        ++cave.number;
        const double begin = cave.clock;
        cave.draw(*cave.walls[0], i);
        const WallPicture rests = cave.draw(*cave.walls[1], 9.0);
        CHECK(cave.clock - begin < 1.1 * kBudget);
        if (rests.divider == 1) CHECK(rests.passes >= last);
        if (rests.divider == 1) last = rests.passes;
    }
    CHECK(last == kMaxPasses);
}

TEST_CASE("equal views: what becomes five thousand times as dear is given up after ten budgets",
          "[session]")
{
    Cave cave({0.02, 0.02});
    for (int i = 0; i < 10; ++i)
        cave.frame(i);
    cave.walls[0]->cost = 100.0; // a pass takes 8000
    const std::vector<WallPicture> pictures = cave.frame(10.0);
    CHECK(cave.seconds < 13.0 * kBudget);
    CHECK(pictures[0].divider > 1);
    CHECK(allSame(pictures)); // the other wall is drawn later
    for (int i = 11; i < 30; ++i)
    {
        CAPTURE(i);
        REQUIRE(allSame(cave.frame(i)));
        if (i > 11) CHECK(cave.seconds < 1.3 * kBudget); // a tile may be too many
    }
}

TEST_CASE("equal views: passes that take far too long are fewer, for those that come later, too",
          "[session]")
{
    Cave cave({0.5, 0.02}); // a pass takes 40
    cave.inputs.maxPasses = 100;
    for (int i = 0; i < 10; ++i)
        cave.frame(i);
    const int passes = cave.frame(10.0)[0].passes;
    CHECK(passes > 3);
    cave.walls[0]->cost = 20.0; // a pass takes 1600: two take more than ten budgets
    const std::vector<WallPicture> pictures = cave.frame(11.0);
    CHECK(pictures[0].passes < passes);
    CHECK(allSame(pictures));
}

TEST_CASE("equal views: frames that nobody numbers, or whose number stays, are frames all the same",
          "[session]")
{
    for (const uint64_t number : {0, 7})
    {
        Cave cave({0.1, 5.0});
        std::vector<WallPicture> pictures;
        for (int i = 0; i < 30; ++i)
        {
            cave.number = number - 1;
            pictures = cave.frame(i);
            CAPTURE(number, i);
            REQUIRE(allSame(pictures));
            if (i > 3) CHECK(cave.seconds < 1.1 * kBudget);
        }
        CHECK(pictures[0].divider < FramePlanner::kFirstDivider);
    }
}

TEST_CASE("equal views: passes that are imposed are traced, whatever they take", "[session]")
{
    Cave cave({1.0, 30.0});
    FrameWork work;
    work.divider = 3;
    work.passes = 2;
    work.progress = FrameWork::kWholePass / 2;
    cave.agreement->impose(work);
    for (int i = 0; i < 5; ++i)
        for (const WallPicture& picture : cave.frame(i))
            CHECK(picture == WallPicture{3, 2, reducedSize(kWidth, 3)});
    cave.frame(4.0); // the view has not settled yet
    for (const WallPicture& picture : cave.frame(4.0))
        CHECK(picture.divider == 3); // half of the tiles of the first pass are traced
    for (const int passes : {1, 1, 2, 2, 3})
        for (const WallPicture& picture : cave.frame(4.0))
            CHECK(picture == WallPicture{1, passes, kWidth});
    const std::optional<FrameWork> offer = cave.agreement->offer(kBudget, true);
    REQUIRE(offer);
    CHECK(offer->divider > 3); // the costs are known nevertheless
}

TEST_CASE("equal views: an offer is by the cost of all views, not of the one drawn last",
          "[session]")
{
    Cave dear({6.0}), empty({0.01}), both({6.0, 0.01});
    std::optional<FrameWork> offers[3];
    Cave* caves[] = {&dear, &empty, &both};
    for (int c = 0; c < 3; ++c)
    {
        CHECK_FALSE(caves[c]->agreement->offer(kBudget, true));
        for (int i = 0; i < 20; ++i)
            caves[c]->frame(i);
        offers[c] = caves[c]->agreement->offer(kBudget, true);
        REQUIRE(offers[c]);
    }
    CHECK(offers[0]->divider > 1);
    CHECK(offers[1]->divider == 1);
    CHECK(offers[1]->passes > 100);
    CHECK(offers[2]->divider == offers[0]->divider);
    CHECK(offers[2]->progress <= offers[0]->progress);
}

TEST_CASE("equal views: traced by several threads at once they agree, too", "[session]")
{
    constexpr int kWalls = 4, kFrames = 60;
    Cave cave({0.05, 3.0, 0.5, 0.2});
    std::vector<std::vector<WallPicture>> shown(kFrames, std::vector<WallPicture>(kWalls));
    std::mutex mutex;
    std::condition_variable arrived;
    int waiting = 0, frame = -1;
    double begun = 0.0;
    std::vector<double> taken; // by each frame
    // Returns once all windows have drawn the frame, as the swap of a frame does.
    const auto barrier = [&]
    {
        std::unique_lock<std::mutex> lock(mutex);
        const int next = frame + 1;
        if (++waiting < kWalls) return arrived.wait(lock, [&] { return frame >= next; });
        waiting = 0;
        frame = next;
        ++cave.number;
        if (next > 5) taken.push_back(cave.clock - begun);
        begun = cave.clock;
        arrived.notify_all();
    };
    const auto run = [&](int wall)
    {
        for (int i = 0; i < kFrames; ++i)
        {
            barrier();
            const double x = i < 30 ? i : 29.0;
            shown[std::size_t(i)][std::size_t(wall)] = cave.draw(*cave.walls[std::size_t(wall)], x);
        }
    };
    std::vector<std::thread> threads;
    for (int wall = 0; wall < kWalls; ++wall)
        threads.emplace_back(run, wall);
    for (std::thread& thread : threads)
        thread.join();
    for (int i = 0; i < kFrames; ++i)
    {
        CAPTURE(i);
        CHECK(allSame(shown[std::size_t(i)]));
    }
    CHECK(shown.back()[0].divider == 1);
    // Costs are not charged exactly to their walls, and by the scheduler's luck a frame may be
    // late.
    const auto median = taken.begin() + static_cast<std::ptrdiff_t>(taken.size() / 2);
    std::nth_element(taken.begin(), median, taken.end());
    CHECK(*median < 1.2 * kBudget);
}
