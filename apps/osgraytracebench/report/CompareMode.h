// CompareMode.h - osgraytracebench compare: which rows of two reports differ by more than their
// noise. Layer: apps.
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
    double probability = 0.0; ///< of a difference this large by chance
};

struct Comparison
{
    std::vector<Change> changes;
    std::size_t tests = 0;
    std::size_t untested = 0;   ///< matched, but of a single seed: noise unknown
    std::size_t onlyInOne = 0;  ///< rows and points that the other report lacks
    double significance = 0.0;  ///< of each test
    double raysPerSecond = 0.0; ///< median of after / before; for information. 0: nothing matched
};

/// Rows are matched by scene, placement, method and budget, sampler points by their number of
/// samples. relMSE and the samplers' errors: Welch's t-test on their logarithms; bias: normal test;
/// non-finite samples: any difference is a change. All tests together raise a false alarm with this
/// probability at most (Sidak); for reports with the same seeds it is smaller, as their noise is
/// shared.
Comparison compareReports(const Report& before, const Report& after, double falseAlarmRate);

/// The program: prints, returns 0 if nothing changed, 1 if something did, 2 if the files cannot be
/// compared.
int runCompare(const std::string& before, const std::string& after, double falseAlarmRate);

} // namespace osgRayTrace::bench
