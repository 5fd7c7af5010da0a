// LatticeEstimate.h - means over the unit cube by shifted lattices, which need fewer points than
// random numbers. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/Statistics.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine::test
{

/// Returns the mean of value(a, b, c) over numbers in [0, 1). points: all, a multiple of 16; they
/// are 16 copies of one additive recurrence with random shifts, whose means are the sixteen values
/// of the estimate.
template <typename Function>
Estimate latticeEstimate(int points, uint32_t seed, const Function& value)
{
    constexpr int kShifts = 16;
    constexpr double kRatio = 1.2207440846057596; // the root of x^4 = x + 1: evenly spread in 3-D
    constexpr double kSteps[] = {1.0 / kRatio, 1.0 / (kRatio * kRatio),
                                 1.0 / (kRatio * kRatio * kRatio)};
    const int each = points / kShifts;
    Uniform random(seed);
    Estimate estimate;
    for (int k = 0; k < kShifts; ++k)
    {
        const double shifts[] = {double(random()), double(random()), double(random())};
        const auto at = [&](int i, int axis)
        {
            const double x = shifts[axis] + kSteps[axis] * i;
            return std::min(static_cast<float>(x - std::floor(x)), 1.0f - 0x1p-24f);
        };
        double sum = 0.0;
        for (int i = 0; i < each; ++i)
            sum += value(at(i, 0), at(i, 1), at(i, 2));
        estimate.add(sum / each);
    }
    return estimate;
}

} // namespace osgRayTrace::engine::test
