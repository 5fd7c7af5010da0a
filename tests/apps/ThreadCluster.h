// ThreadCluster.h - renders in groups whose ranks are threads and whose passes are numbers.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/apps/ThreadGroup.h"

#include "apps/group/SharedRender.h"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

constexpr int kWidth = 5;
constexpr int kHeight = 3;

/// Returns the sums of passes that are numbers; there is one at least.
osgRayTrace::engine::PassSums sumsOf(const osgRayTrace::engine::PassSet& passes,
                                     std::int64_t scale = 1);

bool areEqual(const osgRayTrace::engine::PassSums& a, const osgRayTrace::engine::PassSums& b);

/// A rank whose passes are numbers.
struct Rank
{
    std::string picture = "seed 0\nsize 5 3\n";
    std::string host = "here";
    osgRayTrace::app::Processors processors{4, 1, 4};
    int microseconds = 0;      ///< time of a pass
    int learning = 0;          ///< passes that the rank makes first, for itself
    int failsAtPass = -1;      ///< the rank fails when it is to make this one or a later one
    bool diesSilently = false; ///< in place of failing, the rank says nothing any more
    std::int64_t scale = 1;    ///< of the numbers
};

/// All ranks, and what they have made.
struct ThreadCluster
{
    osgRayTrace::app::GroupPlan plan;
    std::vector<Rank> ranks;
    unsigned seed = 1;
    int delay = 300;            ///< most delay of a message [us]
    double clockRate = 1.0;     ///< of the ranks' clock over the real one
    int interruptedRank = -1;   ///< rank that gets a signal
    int interruptedAtPass = -1; ///< when this pass begins, or a later one
    std::function<double(int passes)> error;

    std::vector<osgRayTrace::engine::PassSet> kept; ///< passes of the checkpoints
    std::vector<int> made;                          ///< passes that each rank has made
    bool sumsAreRight = true;                       ///< those of all rounds
    std::atomic<bool> cancelled{false};

    osgRayTrace::app::GroupResult run();
    int allMade() const;

private:
    osgRayTrace::app::PassWork workOf(int rank);
    osgRayTrace::app::GroupHooks hooksOf(int rank);
    void help(ThreadNetwork& network, int rank);

    std::atomic<bool> _interrupted{false};
    std::atomic<bool> _dead{false};
};
