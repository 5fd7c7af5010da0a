// LampsMode.h - error and cost of scenes with many lamps. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

namespace osgRayTrace::bench
{

/// Measures path tracing under 10 and 1,000 lamps, and how long the table of a million lights
/// takes. only: part of the names of the rows that are wanted.
void measureLamps(const std::string& only, Rows& rows);

} // namespace osgRayTrace::bench
