// SmoothSurface.h - what vertex normals make of the surface points of a block. Layer: accel;
// private to it.
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

/// Moves points, from where rays start, onto the tangent planes of the vertices, weighted as the
/// vertices are [Hanika21]. On a sphere this is as far above the sphere as the facet is below it,
/// enough for every ray above the plane of the shading normal to clear the facets around. On hollow
/// sides nothing moves.
void offsetTerminator(const RayHitBlock& block, const TriangleLanes& t, LaneMask smooth,
                      SurfaceLanes& s);

} // namespace osgRayTrace::engine
