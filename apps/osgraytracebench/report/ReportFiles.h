// ReportFiles.h - a report as JSON and CSV. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Report.h"

#include <string>

namespace osgRayTrace::bench
{

/// Writes JSON; infinite and unknown values are null. Throws app::Failure(kCannotWrite).
void writeJson(const Report& report, const std::string& file);

/// Writes one row a line: those of report.lines, then those of the samplers.
void writeCsv(const Report& report, const std::string& file);

/// Reads a report. Throws app::Failure(kCannotLoad) if the file is not there or is no report.
Report readJson(const std::string& file);

} // namespace osgRayTrace::bench
