// CompareMode.h - osgraytracebench compare: two reports, row by row. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Report.h"

#include <string>
#include <vector>

namespace osgRayTrace::bench
{

struct Change
{
    std::string row; ///< scene, placement, method, budget
    std::string quantity;
    double before = 0.0, after = 0.0;
    double probability = 0.0; ///< probability of a difference this large by chance
};

struct Comparison
{
    std::vector<Change> changes;
    std::size_t tests = 0;
    std::size_t untested = 0;   ///< matched, but of a single seed: noise unknown
    std::size_t onlyInOne = 0;  ///< rows and points that the other report lacks
    double significance = 0.0;  ///< significance of each test
    double raysPerSecond = 0.0; ///< median of after / before, for information; 0: nothing matched
};

/// Returns the rows of two reports that differ by more than their noise. Rows are matched by scene,
/// placement, method and budget, sampler points by their number of samples. relMSE and the
/// samplers' errors go through Welch's t-test on their logarithms, and bias through a normal test;
/// any difference of non-finite samples is a change. All tests together raise a false alarm with
/// this probability at most (Sidak); for reports with equal seeds the probability is smaller, as
/// their noise is shared.
Comparison compareReports(const Report& before, const Report& after, double falseAlarmRate);

/// Runs the program: prints, and returns 0 if nothing changed, 1 if something did, 2 if the files
/// cannot be compared.
int runCompare(const std::string& before, const std::string& after, double falseAlarmRate);

} // namespace osgRayTrace::bench
