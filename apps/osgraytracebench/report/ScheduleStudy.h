// ScheduleStudy.h - bias and variance of photon lookups over the passes. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Report.h"

#include "osgRayTrace/base/Parallel.h"

#include <memory>

namespace osgRayTrace::bench
{

/// Returns the mean of r_i^2 over the passes, divided by r_1^2, for a flat disc as the kernel whose
/// squared radius shrinks as in [Knaus11]: the exact sum over the recurrence of that paper. The
/// bias of the average of passes 1 to N is in proportion to it.
double meanSquaredRadius(int passes, double alpha);

/// Returns the mean of 1 / r_i^2 over the passes, times r_1^2, divided by N. The variance of the
/// average of passes 1 to N is in proportion to it.
double meanInverseSquaredRadius(int passes, double alpha);

/// Studies SPPM on the floor of the flat mirror, with both schedules and alpha = 2/3, or with 1/2
/// and 0.8 as well, beside these sums: for N = 1, 2, 4 ... mostPasses.
std::vector<ScheduleLine> studySchedules(int seeds, int mostPasses, bool allAlphas,
                                         const std::shared_ptr<engine::Workers>& workers);

} // namespace osgRayTrace::bench
