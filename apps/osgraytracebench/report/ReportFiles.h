// ReportFiles.h - a report as JSON and CSV. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Report.h"

#include <string>

namespace osgRayTrace::bench
{

/// Throws app::Failure(kCannotWrite). What is infinite or unknown is null.
void writeJson(const Report& report, const std::string& file);

/// One row a line: that of report.lines, then those of the samplers.
void writeCsv(const Report& report, const std::string& file);

/// Throws app::Failure(kCannotLoad) if it is not there or is no report.
Report readJson(const std::string& file);

} // namespace osgRayTrace::bench
