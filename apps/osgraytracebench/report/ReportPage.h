// ReportPage.h - a report as one page that needs nothing else. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Expectations.h"
#include "apps/osgraytracebench/report/Thumbnails.h"

namespace osgRayTrace::bench
{

/// Returns HTML with plots, tables and pictures within. verdicts: those of a quick report, else
/// empty.
std::string reportPage(const Report& report, const std::vector<SceneThumbnails>& thumbnails,
                       const std::vector<Verdict>& verdicts);

} // namespace osgRayTrace::bench
