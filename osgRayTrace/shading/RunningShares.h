// RunningShares.h - a discrete distribution as its running sums. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace osgRayTrace::engine
{

/// Returns the index of the entry of a cumulative distribution that u in [0,1) falls into, and
/// rescales u within the entry.
inline std::size_t pick(const std::vector<float>& cumulative, float& u)
{
    const auto at = std::upper_bound(cumulative.begin(), cumulative.end() - 1, u);
    const auto index = static_cast<std::size_t>(at - cumulative.begin());
    const float low = index ? cumulative[index - 1] : 0.0f;
    const float width = cumulative[index] - low;
    u = width > 0.0f ? std::min((u - low) / width, kOneMinusEpsilon) : 0.0f;
    return index;
}

/// Returns running sums, computed in double and scaled to end at exactly 1; empty if all weights
/// are 0.
inline std::vector<float> cumulativeOf(const std::vector<double>& weights)
{
    double total = 0.0;
    for (const double w : weights)
        total += w;
    if (!(total > 0.0)) return {};
    std::vector<float> cumulative;
    cumulative.reserve(weights.size());
    double sum = 0.0;
    for (const double w : weights)
        cumulative.push_back(static_cast<float>((sum += w) / total));
    cumulative.back() = 1.0f;
    return cumulative;
}

} // namespace osgRayTrace::engine
