// SurfaceAttributes.h - what a mesh has at its vertices, at a hit: where its material is asked for.
// Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/SurfaceTable.h"
#include "osgRayTrace/shading/MaterialTable.h"

namespace osgRayTrace::engine
{

/// Where the material is at a hit. direction: of the ray, unit. The eye's axes are left to the
/// caller.
MaterialPoint materialPointOf(const SurfaceRecord& record, const MaterialRecord& material,
                              uint32_t primitive, float u, float v, bool front, Vec3 direction);

/// Texture coordinates of unit 0 at a hit; zero if the mesh has none.
Vec2 interpolateUv(const SurfaceRecord& record, uint32_t primitive, float u, float v);

/// RGBA vertex colour at a hit; white if the mesh has none.
Vec4 interpolateColor(const SurfaceRecord& record, uint32_t primitive, float u, float v);

} // namespace osgRayTrace::engine
