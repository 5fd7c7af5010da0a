// MergeHits.h - one block of what some lanes met later than the others. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/accel/SurfaceLanes.h"

namespace osgRayTrace::engine
{

/// Takes what the rays of some lanes met from a block of the same rays that was traced for these
/// lanes alone: distances, hits and surfaces.
void mergeHits(const RayHitBlock& later, const SurfaceLanes& laterSurface, LaneMask lanes,
               RayHitBlock& rays, SurfaceLanes& surface);

} // namespace osgRayTrace::engine
