// Surface.h - the surface points that a block of rays hit. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/accel/SurfaceLanes.h"
#include "osgRayTrace/accel/SurfaceTable.h"
#include "osgRayTrace/accel/TriangleLanes.h"

namespace osgRayTrace::engine
{

/// The start of rays that leave a smooth triangle on the side that the incoming ray comes from.
enum class RayStart
{
    Triangle, ///< on the triangle
    Smooth,   ///< on facets of convex bodies: the smooth surface that the vertex normals imply
};

/// The triangle that all hits of an earlier block were on. The hits of the next block are often on
/// the same triangle. A LastTriangle is valid for one scene only.
struct LastTriangle
{
    uint32_t geometry = kInvalid, instance = kInvalid, primitive = kInvalid; ///< Embree's numbers
    uint32_t sceneInstance, material;
    bool smooth, mirrored;
    TrianglePlane plane;
    TriangleLanes lanes; ///< set in the first lane; in all lanes if smooth
};

/// Sets the surfaces at the hits of the active lanes of a block. The values of lanes
/// without a hit have no meaning. A point is k * 2^-24 * sum(max |vertex coordinate| * |normal|)
/// off its triangle at most; k = 32 leaves 1.5e-6 false hits at worst, and none on translated
/// scenes (measured with Embree 3.13.5). The offset adds Embree's own error of the distance to the
/// plane, 8 * 2^-24 * longest edge, because a plane through the origin has no coordinates to err
/// by.
///
/// RayStart::Smooth hides the terminator of the facets, which shows wherever the shading normals
/// still see a light that the facet turns its back to. In the lanes that get a terminator offset
/// the shading normal alone decides on which side a light is. Flat facets and hollow sides get no
/// terminator offset.
///
/// The triangle `last` saves time for blocks of neighbouring rays and changes no result. It is null
/// for a block that has no neighbours.
void surfacesOf(const SurfaceTable& table, const RayHitBlock& block, LaneMask active,
                SurfaceLanes& surface, RayStart start = RayStart::Triangle,
                LastTriangle* last = nullptr);

/// Returns the vertices of the triangle that the ray of a lane hit.
PlainTriangle triangleAt(const SurfaceTable& table, const RayHitBlock& block, int lane);

/// Sets normal to the shading normal, turned to the side that the ray comes from, or to the
/// geometric normal if the two disagree so much that the ray would come from behind the shading
/// normal. The normals of all lanes are set, also those of lanes without a hit.
void facingNormalLanes(const RayBlock& ray, const SurfaceLanes& surface, Vec3Lanes& normal);

} // namespace osgRayTrace::engine
