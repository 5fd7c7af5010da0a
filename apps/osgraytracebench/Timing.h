// Timing.h - medians of paired runs, so that ratios hold on a noisy machine. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

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

/// Runs the two in turn, after one turn that is not counted.
inline PairedTimes timePair(int runs, const std::function<void()>& first, const std::function<void()>& second)
{
    first();
    second();
    std::vector<double> firsts, seconds, ratios;
    for (int i = 0; i < runs; ++i)
    {
        firsts.push_back(secondsOf(first));
        seconds.push_back(secondsOf(second));
        ratios.push_back(firsts.back() / seconds.back());
    }
    return {median(firsts), median(seconds), median(ratios)};
}

} // namespace osgRayTrace::bench
