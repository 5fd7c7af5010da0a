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
    double error = 0.0; ///< standard error; infinite of a single value
};

Mean meanOf(const std::vector<double>& values);

struct Slope
{
    double value = 0.0;
    double error = 0.0; ///< standard error, by leaving out one series in turn
};

/// Slope of log(mean of y) over log(mean of x). Each series is an independent repetition of the
/// same experiment: points (x, y) in the same order; later ones may be missing. Points whose mean y
/// is not positive are left out. Nothing below two points.
struct Series
{
    std::vector<double> x, y;
};
std::optional<Slope> logLogSlope(const std::vector<Series>& series);

/// x at which y falls to the target: by power laws between neighbours. Nothing if it does not get
/// there or begins below it.
std::optional<double> crossing(const std::vector<double>& x, const std::vector<double>& y,
                               double target);

/// Probability that |t| of Student's distribution with these degrees of freedom exceeds the value.
double studentTail(double t, double degrees);

/// Significance of each of count tests so that all together raise a false alarm with this
/// probability.
double sidak(double significance, std::size_t count);

} // namespace osgRayTrace::bench
