// LimitMode.h - how near a whole frame comes to Embree alone. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

namespace osgRayTrace::bench
{

/// Measures frames at 1920 x 1080 (camera rays, one shadow ray a pixel to an area light, shading,
/// film, tone mapping) against the same rays through bare Embree; path tracing against the same
/// rays one at a time; two threads against one; graph to ready BVH against Embree's own build and
/// one copy. Only parts whose name holds `only` are measured.
void measureLimit(const std::string& only, Rows& rows);

/// Adds the rows of measureLimit that concern building.
void measureBuild(Rows& rows);

} // namespace osgRayTrace::bench
