// ScheduleStudy.h - bias and variance of photon lookups against the number of passes. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Report.h"

#include "osgRayTrace/base/Parallel.h"

#include <memory>

namespace osgRayTrace::bench
{

/// How far the average of passes 1 to N is from what is right, for a flat disc as the kernel whose
/// squared radius goes as [Knaus11]: the exact sums over its recurrence.
double meanSquaredRadius(int passes, double alpha); ///< of the passes, over that of the first
double meanInverseSquaredRadius(int passes, double alpha); ///< times that of the first, over N

/// SPPM on the floor of the flat mirror, with both schedules and alpha = 2/3, or with 1/2 and 0.8
/// as well, beside those sums: for N = 1, 2, 4 ... mostPasses.
std::vector<ScheduleLine> studySchedules(int seeds, int mostPasses, bool allAlphas,
                                         const std::shared_ptr<engine::Workers>& workers);

} // namespace osgRayTrace::bench
