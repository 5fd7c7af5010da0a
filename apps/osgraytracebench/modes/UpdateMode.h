// UpdateMode.h - the cost of edits of a large live scene. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

namespace osgRayTrace::bench
{

/// Measures 10,000 objects of 1,000 triangles: a walk that finds no change, one moved transform
/// against Embree's own commit of as many instances, 1 % of the meshes deformed against Embree's
/// own refit of them, and an edited material; also the memory of 10,000 instances of one mesh, and
/// rays through them. All times are one thread's own, so that a busy machine changes nothing.
void measureUpdate(Rows& rows);

} // namespace osgRayTrace::bench
