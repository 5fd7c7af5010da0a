// FramePlanTest.cpp - resolutions and passes follow from costs, and do not flicker. No test needs a
// clock.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/film/TileOrder.h"
#include "osgRayTrace/session/view/FramePlan.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace osgRayTrace::engine;

namespace
{

constexpr int kWidth = 1920, kHeight = 1080;

int tilesAt(int divider)
{
    return tilesOf(reducedSize(kWidth, divider), reducedSize(kHeight, divider));
}

/// Simulates frames of a machine whose costs only the test knows.
struct Machine
{
    double passSeconds = 0.2;     ///< of full resolution
    double reducedPenalty = 1.25; ///< factor for a tile of reduced resolution
    double photonSeconds = 0.0;   ///< of each moved frame
    double noise = 0.1;           ///< standard deviation, relative
    double budget = 0.033;
    std::mt19937 random{7};

    double tile(int divider)
    {
        const test::NormalNumbers normal(1.0, noise);
        const double seconds = passSeconds / tilesAt(1) * (divider > 1 ? reducedPenalty : 1.0);
        return seconds * std::clamp(normal(random), 0.5, 1.5);
    }

    struct Frame
    {
        int divider;
        double whole;   ///< time of the first pass, with photons
        double seconds; ///< with the passes that were added until the budget was spent
    };

    Frame moved(FramePlanner& planner)
    {
        FrameSituation frame;
        frame.width = kWidth;
        frame.height = kHeight;
        frame.seconds = budget;
        frame.moved = true;
        const FramePlan plan = planner.plan(frame);
        const double cost = tile(plan.divider),
                     whole = photonSeconds + cost * tilesAt(plan.divider);
        const double most = photonSeconds + cost * tilesAt(plan.divider) * plan.passes;
        const double seconds = std::max(whole, std::min(most, budget));
        planner.recordTiles(plan.divider, static_cast<int>((seconds - photonSeconds) / cost + 0.5),
                            seconds - photonSeconds);
        planner.recordPhotons(photonSeconds);
        return {plan.divider, whole, seconds};
    }

    void still(FramePlanner& planner, int tilesLeft = 0)
    {
        FrameSituation frame;
        frame.width = kWidth;
        frame.height = kHeight;
        frame.seconds = budget;
        frame.tilesLeft = tilesLeft;
        CHECK(planner.plan(frame).divider == 1);
        const double cost = tile(1);
        planner.recordTiles(1, static_cast<int>(budget / cost), budget);
    }
};

std::vector<Machine::Frame> run(Machine& machine, FramePlanner& planner, int frames)
{
    std::vector<Machine::Frame> result;
    for (int i = 0; i < frames; ++i)
        result.push_back(machine.moved(planner));
    return result;
}

int changes(const std::vector<Machine::Frame>& frames)
{
    int count = 0;
    for (std::size_t i = 1; i < frames.size(); ++i)
        count += frames[i].divider != frames[i - 1].divider;
    return count;
}

} // namespace

TEST_CASE("frame plan: moving views fit into their budgets and fill them", "[session]")
{
    for (const double budget : {0.016, 0.033, 0.1})
    {
        for (const double pass : {0.002, 0.02, 0.08, 0.3, 1.5, 5.0})
        {
            CAPTURE(budget, pass);
            Machine machine;
            machine.budget = budget;
            machine.passSeconds = pass;
            FramePlanner planner;
            const auto frames = run(machine, planner, 200);
            int late = 0;
            double spent = 0.0;
            for (std::size_t i = 20; i < frames.size(); ++i)
            {
                late += frames[i].seconds > 1.1 * budget;
                spent += frames[i].seconds / budget / 180.0;
            }
            CHECK(late <= 4); // of 180, with a tenth of noise
            CHECK(spent > 0.9);
            // The resolution is as fine as fits: the next finer pass would not have been within
            // kLittle of the budget.
            const int divider = frames.back().divider;
            if (divider > 1)
                CHECK(pass * machine.reducedPenalty / ((divider - 1) * (divider - 1)) >
                      0.9 * HeldDivider::kLittle * budget);
        }
    }
}

TEST_CASE("frame plan: the resolution is held while the view moves", "[session]")
{
    // With a tenth of noise there is no flicker, whatever divider the cost is near to.
    for (double pass = 0.03; pass < 1.0; pass *= 1.07)
    {
        CAPTURE(pass);
        Machine machine;
        machine.passSeconds = pass;
        FramePlanner planner;
        run(machine, planner, 60);
        CHECK(changes(run(machine, planner, 300)) <= 1);
    }
}

TEST_CASE("frame plan: coarser at once, finer with patience", "[session]")
{
    Machine machine;
    machine.noise = 0.0;
    FramePlanner planner;
    const int divider = run(machine, planner, 40).back().divider;
    CHECK(divider == 4); // 0.2 * 1.25 / 16 is below 0.75 of the budget, 0.2 * 1.25 / 9 above

    machine.passSeconds = 1.0; // the view has turned to heavy objects
    const auto heavy = run(machine, planner, 3);
    CHECK(heavy[0].divider == divider);
    CHECK(heavy[1].divider > divider);
    CHECK(heavy[1].whole <= HeldDivider::kChosen * machine.budget * 1.01);
    CHECK(heavy[2].divider == heavy[1].divider);

    machine.passSeconds = 0.2;
    const auto light = run(machine, planner, 60);
    CHECK(light[HeldDivider::kPatience - 2].divider == heavy[1].divider);
    CHECK(light.back().divider <= 5); // within kLittle; 4 takes a bit more
    CHECK(changes(light) <= 3);
}

TEST_CASE("frame plan: photons leave less for the picture", "[session]")
{
    Machine machine, withPhotons;
    machine.noise = withPhotons.noise = 0.0;
    withPhotons.photonSeconds = 0.02;
    FramePlanner planner, other;
    const auto without = run(machine, planner, 40).back();
    const auto with = run(withPhotons, other, 40).back();
    CHECK(with.divider > without.divider);
    CHECK(with.whole < 0.033);

    withPhotons.photonSeconds = 0.05; // more than the budget: the frame is late, but goes on
    const auto late = run(withPhotons, other, 40).back();
    CHECK(late.divider == FramePlanner::kLargestDivider);
}

TEST_CASE("frame plan: a view at rest has full resolution, passes to fill the frame", "[session]")
{
    Machine machine;
    machine.noise = 0.0;
    machine.passSeconds = 0.01;
    FramePlanner planner;
    FrameSituation frame;
    frame.width = kWidth;
    frame.height = kHeight;
    frame.seconds = 0.033;
    CHECK(planner.plan(frame).passes == 1); // costs are unknown
    machine.still(planner);
    CHECK(planner.plan(frame).passes == 4); // three, and a part of one
    frame.tilesLeft = tilesAt(1) / 2;
    CHECK(planner.plan(frame).passes == 4); // half a one, two, and a part of one
    machine.passSeconds = 0.2;
    for (int i = 0; i < 40; ++i)
        machine.still(planner);
    frame.tilesLeft = 0;
    CHECK(planner.plan(frame).passes == 1);
    frame.tilesLeft = tilesAt(1) / 20;
    CHECK(planner.plan(frame).passes == 2); // the last tiles of one, and the next
}

TEST_CASE("frame plan: a motion begins with what the still view cost", "[session]")
{
    Machine machine;
    machine.noise = 0.0;
    FramePlanner planner;
    for (int i = 0; i < 10; ++i)
        machine.still(planner);
    const auto frames = run(machine, planner, 10);
    CHECK(frames.front().whole < 0.9 * machine.budget);
    CHECK(changes(frames) == 0);
}

TEST_CASE("frame plan: without degrading the resolution stays", "[session]")
{
    Machine machine;
    FramePlanner planner;
    run(machine, planner, 10);
    FrameSituation frame;
    frame.width = kWidth;
    frame.height = kHeight;
    frame.seconds = 0.016;
    frame.moved = true;
    frame.degrade = false;
    CHECK(planner.plan(frame).divider == 1);
    CHECK_FALSE(planner.givesUp(frame, 1, 1000, 1.0));
}

TEST_CASE("frame plan: what turns out to be too much is given up in time", "[session]")
{
    FramePlanner planner;
    FrameSituation frame;
    frame.width = kWidth;
    frame.height = kHeight;
    frame.seconds = 0.03;
    frame.moved = true;
    const int all = tilesAt(2);
    CHECK_FALSE(planner.givesUp(frame, 2, 1, 1.0));            // one tile tells nothing
    CHECK_FALSE(planner.givesUp(frame, 2, all / 4, 0.03 / 4)); // it fits
    CHECK(planner.givesUp(frame, 2, all / 4, 0.06 / 4));
    CHECK_FALSE(planner.givesUp(frame, 2, all * 3 / 4, 0.06 * 3 / 4)); // too late
    CHECK_FALSE(planner.givesUp(frame, FramePlanner::kLargestDivider, 40, 1.0));

    planner.recordTiles(2, all / 4, 0.06 / 4);
    frame.seconds = 0.015;
    const FramePlan plan = planner.replan(frame);
    CHECK(plan.divider > 2);
    CHECK(0.06 / all * tilesAt(plan.divider) <= HeldDivider::kChosen * 0.015);
}

TEST_CASE("frame plan: views of any size", "[session]")
{
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(1, 5000), std::pair(17, 3)})
    {
        FramePlanner planner;
        FrameSituation frame;
        frame.width = width;
        frame.height = height;
        frame.seconds = 1e-9;
        frame.moved = true;
        planner.recordTiles(1, 1, 1.0);
        const FramePlan plan = planner.plan(frame);
        CHECK(reducedSize(width, plan.divider) >= 1);
        CHECK(plan.passes >= 1);
        frame.seconds = 1e9;
        CHECK(planner.plan(frame).passes < 1 << 21);
    }
}

TEST_CASE("tile order: each tile once, and any few of them all over the image", "[session]")
{
    for (const std::size_t count : {1u, 2u, 3u, 4u, 60u, 64u, 97u, 510u, 8160u})
    {
        CAPTURE(count);
        const std::size_t stride = evenStride(count);
        std::vector<int> seen(count);
        std::size_t quarters[4] = {};
        for (std::size_t i = 0; i < count; ++i)
        {
            const std::size_t tile = i * stride % count;
            ++seen[tile];
            if (i < count / 8) ++quarters[4 * tile / count];
        }
        CHECK(std::count(seen.begin(), seen.end(), 1) == static_cast<int>(count));
        for (const std::size_t quarter : quarters)
            CHECK(std::abs(static_cast<double>(quarter) - count / 32.0) <= 2.0);
    }
}

TEST_CASE("frame plan: full resolution may take the time that upsampling would", "[session]")
{
    FrameSituation frame;
    frame.width = 1280;
    frame.height = 720;
    frame.seconds = 0.013;
    frame.moved = true;
    const int tiles = tilesOf(frame.width, frame.height);
    for (const double fullSeconds : {0.0, 0.031})
    {
        FramePlanner planner;
        planner.recordTiles(1, tiles, 0.016); // fits into 31 ms, but not into 13
        frame.fullSeconds = fullSeconds;
        CHECK((planner.plan(frame).divider == 1) == (fullSeconds > 0.0));
    }

    // A view that was reduced becomes whole as soon as that fits well for a while.
    FramePlanner planner;
    planner.recordTiles(1, tiles, 0.060);
    REQUIRE(planner.plan(frame).divider > 1);
    int frames = 0;
    for (int divider = 2; divider > 1 && frames < 100; ++frames)
    {
        planner.recordTiles(divider, tiles / 4, 0.016 / 4);
        divider = planner.plan(frame).divider;
    }
    CHECK(frames > HeldDivider::kPatience);
    CHECK(frames < 4 * HeldDivider::kPatience);
}

TEST_CASE("frame plan: without time left the image is the coarsest, never of full resolution",
          "[session]")
{
    for (const double left : {0.0, -1e-6, -0.005, -0.1})
    {
        FrameSituation frame;
        frame.width = 1280;
        frame.height = 720;
        frame.moved = true;
        frame.fullSeconds = 0.02;
        const int tiles = tilesOf(frame.width, frame.height);
        FramePlanner planner;
        planner.recordTiles(1, tiles, 0.095);
        frame.seconds = left;
        CAPTURE(left);
        CHECK(planner.replan(frame).divider == FramePlanner::kLargestDivider);
        CHECK(planner.plan(frame).divider == FramePlanner::kLargestDivider);
    }
}
