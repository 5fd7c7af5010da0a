// UpdateMode.h - what an edit of a large live scene costs. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

namespace osgRayTrace::bench
{

/// 10,000 objects of 1,000 triangles: a walk that finds no change, one moved transform against
/// Embree's own commit of as many instances, 1 % of the meshes deformed against Embree's own refit
/// of them, an edited material; what 10,000 instances of one mesh take, and rays through them. All
/// on one thread, by its own time, so that a busy machine changes nothing.
void measureUpdate(Rows& rows);

} // namespace osgRayTrace::bench
