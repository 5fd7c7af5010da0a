// DaylightMode.h - error and cost of rooms with a window, skies and large panels. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

namespace osgRayTrace::bench
{

/// Measures path tracing of the scenes of DaylightScenes and of the Cornell box. only: part of the
/// names of the rows that are wanted.
void measureDaylight(const std::string& only, Rows& rows);

} // namespace osgRayTrace::bench
