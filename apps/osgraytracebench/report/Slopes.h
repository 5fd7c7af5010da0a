// Slopes.h - fits and statistics that the report needs. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

namespace osgRayTrace::bench
{

struct Mean
{
    double value = 0.0;
    double error = 0.0; ///< standard error; infinite for a single value
};

Mean meanOf(const std::vector<double>& values);

struct Slope
{
    double value = 0.0;
    double error = 0.0; ///< standard error, by leaving out one series in turn
};

/// Holds one of several independent repetitions of an experiment: points (x, y) in an order that
/// all series share; later points may be missing.
struct Series
{
    std::vector<double> x, y;
};
/// Returns the slope of log(mean of y) over log(mean of x), without points whose mean y is not
/// positive; nothing below two points.
std::optional<Slope> logLogSlope(const std::vector<Series>& series);

/// Returns the x at which y falls to the target, by power laws between neighbours; nothing if y
/// does not get there or begins below the target.
std::optional<double> crossing(const std::vector<double>& x, const std::vector<double>& y,
                               double target);

/// Returns the probability that |t| of Student's distribution with these degrees of freedom exceeds
/// the value.
double studentTail(double t, double degrees);

/// Returns the significance of each of count tests so that all together raise a false alarm with
/// this probability.
double sidak(double significance, std::size_t count);

} // namespace osgRayTrace::bench
