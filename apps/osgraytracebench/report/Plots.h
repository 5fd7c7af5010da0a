// Plots.h - the report's plots, by gnuplot. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Report.h"

#include <string>
#include <vector>

namespace osgRayTrace::bench
{

/// Returns whether gnuplot can be run. Plots are empty without it.
bool haveGnuplot();

/// Returns relMSE against seconds of lines of one scene, log-log, one standard error up and down,
/// with guides of slope -2/3, -1, -3/2 and -2: a <figure> element with a legend.
std::string errorPlot(const std::vector<const ReportLine*>& lines);

/// Returns the mean squared error against the number of samples of the strategies of one case, with
/// guides of slope -1, -3/2, -2 and -3: a <figure> element.
std::string samplerPlot(const std::vector<const SamplerLine*>& lines);

/// Returns squared bias and variance against the number of passes, points over the lines of the
/// formulas: a <figure> element.
std::string schedulePlot(const std::vector<ScheduleLine>& lines);

} // namespace osgRayTrace::bench
