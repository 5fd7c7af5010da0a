// StatisticsText.h - statistics of a render as JSON, and as one line for people. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Options.h"

#include "apps/common/ErrorMeasures.h"

#include <osgRayTrace/Statistics>

#include <optional>
#include <string>

namespace osgRayTrace::app
{

/// Returns JSON whose keys are the names of Statistics' members; numbers that are not finite are
/// null.
std::string statisticsJson(const Options& options, const Statistics& statistics,
                           const std::optional<ErrorMeasures>& measures);

/// Returns "path, 64 passes in 3.2 s, 41 M rays/s, estimated error 0.81 % (...)", and whether that
/// is what was asked for. If the picture shows nothing the line says so instead of the error.
std::string statisticsLine(const Options& options, const Statistics& statistics,
                           const osg::Image& radiance);

} // namespace osgRayTrace::app
