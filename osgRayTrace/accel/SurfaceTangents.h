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
    uint32_t instance, primitive;
    float u, v;
};

/// Returns the axes at a point of a mesh: its tangents, or the directions of its texture
/// coordinates of that set, as applyNormalMaps says. Nothing if the mesh has neither, or if there
/// is no area in the texture.
std::optional<SurfaceAxes> surfaceAxes(const TracedScene& traced, const TrianglePoint& point,
                                       uint32_t uvSet, Vec3 normal);

/// Turns what depends on the axes of the mesh, see Bsdf::needsAxes, to those of frameOf(normal), in
/// which the Bsdf is evaluated; normal: as facingNormalLanes sets it. That is the tangent of an
/// anisotropic surface, which becomes isotropic if there are no axes, and the normal of a clear
/// coat, with the mean that depends on it.
void alignLayers(const TracedScene& traced, const RayHitBlock& rays, const SurfaceLanes& surface,
                 int i, Vec3 normal, Bsdf& bsdf);

} // namespace osgRayTrace::engine
