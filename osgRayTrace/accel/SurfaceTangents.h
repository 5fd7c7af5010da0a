// SurfaceTangents.h - the axes of texture coordinates on a surface. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/accel/SurfaceLanes.h"
#include "osgRayTrace/accel/TracedScene.h"

#include <optional>

namespace osgRayTrace::engine
{

/// Holds the directions of normal maps and of anisotropy: unit vectors in engine space, orthogonal
/// to each other and to the normal.
struct SurfaceAxes
{
    Vec3 tangent, bitangent;
};

struct TrianglePoint
{
    uint32_t primitive;
    float u, v;
};

/// Returns the axes at a point of a mesh: its tangents, or the directions of its texture
/// coordinates, as applyNormalMaps says. second: those of unit 1. Nothing if the mesh has neither,
/// or if the triangle has no area in the texture.
std::optional<SurfaceAxes> surfaceAxes(const SurfaceRecord& record, const TrianglePoint& point,
                                       bool second, Vec3 normal);

/// Turns the tangent of an anisotropic surface from the axes of texture coordinates to those of
/// frameOf(normal), in which the Bsdf is evaluated; normal: as facingNormalLanes sets it. Without
/// axes the surface becomes isotropic.
void alignTangent(const TracedScene& traced, const RayHitBlock& rays, const SurfaceLanes& surface,
                  int i, Vec3 normal, Bsdf& bsdf);

} // namespace osgRayTrace::engine
