// Timing.h - medians of paired runs, so that ratios hold on a noisy machine. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

namespace osgRayTrace::bench
{

inline double secondsOf(const std::function<void()>& body)
{
    const auto begin = std::chrono::steady_clock::now();
    body();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Returns the calling thread's own seconds, which hold no time of other programs on a busy
/// machine.
inline double threadSecondsOf(const std::function<void()>& body)
{
    const auto now = []
    {
        timespec time;
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    };
    const double begin = now();
    body();
    return now() - begin;
}

inline double median(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

struct PairedTimes
{
    double first = 0.0;  ///< median [s]
    double second = 0.0; ///< median [s]
    double ratio = 0.0;  ///< median of first / second, run by run
};

using Stopwatch = double (*)(const std::function<void()>&);

/// Returns the clock for work on so many threads: one thread's own time, or wall clock time for
/// more.
inline Stopwatch stopwatchFor(int threads)
{
    return threads == 1 ? threadSecondsOf : secondsOf;
}

/// Runs first and second in turn, after one turn that is not counted. Throws Interrupted after a
/// signal.
inline PairedTimes timePair(int runs, const std::function<void()>& first,
                            const std::function<void()>& second, Stopwatch stopwatch = secondsOf)
{
    first();
    second();
    std::vector<double> firsts, seconds, ratios;
    for (int i = 0; i < runs; ++i)
    {
        endIfInterrupted();
        firsts.push_back(stopwatch(first));
        seconds.push_back(stopwatch(second));
        ratios.push_back(firsts.back() / seconds.back());
    }
    return {median(firsts), median(seconds), median(ratios)};
}

} // namespace osgRayTrace::bench
