// Measurement.h - renders a method's pictures and works out its rows. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Reference.h"
#include "apps/osgraytracebench/report/Report.h"

namespace osgRayTrace::bench
{

/// Holds budgets, each the double of the one before, and the number of seeds that get that far.
struct BudgetPlan
{
    bool timed = true; ///< true: budgets are seconds; false: passes
    std::vector<double> budgets;
    std::vector<int> seeds; ///< seeds of each budget, falling
};

/// Returns budgets from 1/8 s to the longest, 8 s if not told otherwise: 8 seeds up to 1 s, 4 up to
/// 4 s, 2 beyond.
BudgetPlan timedPlan(double longest);

/// Returns budgets of 2 to 64 passes with so many seeds; 0: 16 seeds, or 8 for methods that look up
/// photons.
BudgetPlan quickPlan(const Method& method, int seeds);

/// Holds a line, with one picture for people: that of the first seed, at a budget in the middle.
struct MeasuredLine
{
    ReportLine line;
    Pixels picture;
    double pictureBudget = 0.0;
};

/// Measures a line: each seed's picture is made once and looked at when it reaches a budget.
MeasuredLine measure(const ReportScene& scene, const Placement& placement, const Method& method,
                     const PreparedScene& prepared, const Reference& reference,
                     const BudgetPlan& plan);

} // namespace osgRayTrace::bench
