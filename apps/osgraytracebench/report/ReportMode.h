// ReportMode.h - osgraytracebench report. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace osgRayTrace::bench
{

struct ReportOptions
{
    std::string folder = "report";
    bool quick = false;
    double longest = 8.0; ///< longest budget [s]
    int width = 0;        ///< width of the pictures [pixels]; 0: 32 if quick, else 128
    int seeds = 0;        ///< pictures of each method of a quick report; 0: 8 or 16, see quickPlan
    std::string only;     ///< part of the names of scenes that are measured; empty: all
    std::vector<std::string> models; ///< models measured in place of the report's own scenes
    std::string expectations;        ///< file; empty: expectations built into this program
};

/// Writes report.html, .csv and .json into the folder. Returns the program's exit code: 5 if a
/// quick report fails one of its checks. Throws app::Failure and engine::EngineError.
int runReport(const ReportOptions& options);

} // namespace osgRayTrace::bench
