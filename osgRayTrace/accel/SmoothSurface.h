// SmoothSurface.h - applies vertex normals to surface points. Layer: accel; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/accel/SurfaceLanes.h"
#include "osgRayTrace/accel/TriangleLanes.h"

namespace osgRayTrace::engine
{

/// Sets the shading normals of the smooth lanes to the interpolated vertex normals.
void interpolateNormals(const RayHitBlock& block, const TriangleLanes& t, LaneMask smooth,
                        SurfaceLanes& s);

/// Moves the points at which rays start onto the tangent planes of the vertices, weighted by the
/// barycentric weights of the vertices [Hanika21]. On a sphere the moved point is as far above the
/// sphere as the facet is below it, which is enough for every ray above the plane of the shading
/// normal to clear the facets around. Points on hollow sides do not move.
void offsetTerminator(const RayHitBlock& block, const TriangleLanes& t, LaneMask smooth,
                      SurfaceLanes& s);

} // namespace osgRayTrace::engine
