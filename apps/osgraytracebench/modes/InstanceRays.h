// InstanceRays.h - rays through ten thousand instances against Embree's own instances. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

namespace osgRayTrace::bench
{

/// Camera rays, rays in any direction from where these end, and shadow rays, through 10,000
/// instances of a mesh of 1,000 triangles: apart and upright, and turned in each other's way. On
/// one thread, by its own time.
void measureInstanceRays(Rows& rows);

} // namespace osgRayTrace::bench
