// SurfaceAttributes.h - interpolates the vertex attributes of a mesh at a hit. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/SurfaceTable.h"
#include "osgRayTrace/shading/MaterialTable.h"

namespace osgRayTrace::engine
{

/// Returns the point at which the material is evaluated for a hit. `direction` is the unit
/// direction of the ray. The caller sets the axes of the eye.
MaterialPoint materialPointOf(const SurfaceRecord& record, const MaterialRecord& material,
                              uint32_t primitive, float u, float v, bool front, Vec3 direction);

/// Returns the square root of a triangle's area in texture coordinates over its area in engine
/// space: 1 / length. 0 if it has no coordinates or no area.
float textureScale(const SurfaceRecord& record, const Vec2* uvs, uint32_t primitive);

/// Sets the widths of a footprint in texture coordinates. footprint: width on the surface [engine
/// units].
void setTextureWidths(const SurfaceRecord& record, uint32_t primitive, float footprint,
                      MaterialPoint& point);

/// Returns the texture coordinates of unit 0 at a hit, zero if the mesh has none.
Vec2 interpolateUv(const SurfaceRecord& record, uint32_t primitive, float u, float v);

/// Returns the RGBA vertex colour at a hit, white if the mesh has none.
Vec4 interpolateColor(const SurfaceRecord& record, uint32_t primitive, float u, float v);

} // namespace osgRayTrace::engine
