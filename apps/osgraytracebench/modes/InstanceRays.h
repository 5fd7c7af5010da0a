// InstanceRays.h - rays through many instances against Embree's own instances. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

namespace osgRayTrace::bench
{

/// Measures camera rays, rays in any direction from the ends of these, and shadow rays, through
/// 10,000 instances of a mesh of 1,000 triangles: apart and upright, and turned in each other's
/// way. Times are one thread's own.
void measureInstanceRays(Rows& rows);

} // namespace osgRayTrace::bench
