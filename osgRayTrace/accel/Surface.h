// Surface.h - the surface points that a block of rays hit. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/accel/SurfaceTable.h"
#include "osgRayTrace/accel/TriangleLanes.h"
#include "osgRayTrace/base/Lanes.h"

namespace osgRayTrace::engine
{

/// Hit points rebuilt from barycentric coordinates, with the bound of their rounding error.
struct SurfaceLanes
{
    Vec3Lanes position;        ///< on the triangle, but for terminatorLanes: where their rays start
    Vec3Lanes geometricNormal; ///< unit, on the side that the ray comes from
    Vec3Lanes shadingNormal;   ///< unit; as the mesh has it: not turned to either side
    FloatLanes offset;         ///< distance along geometricNormal that clears the error of position
    FloatLanes minCosine;      ///< cosine above which rays may begin at position itself: see leave
    UintLanes instance;        ///< index into Scene::instances; undefined outside of hits
    UintLanes material;        ///< index into Scene::materials
    LaneMask hits = 0;
    LaneMask front = 0;           ///< the ray comes from the mesh's counter-clockwise side
    LaneMask terminatorLanes = 0; ///< hits whose position is above their triangle: see RayStart
    Vec3Lanes onTriangle;         ///< position without terminator offset; unset if no lane is
};

/// Where the rays of a smooth triangle that leave it on the ray's side start.
enum class RayStart
{
    Triangle, ///< on the triangle
    Smooth,   ///< where it is a facet of a convex body: on the surface that its vertex normals mean
};

/// The points on the triangles, with a terminator offset or not.
inline const Vec3Lanes& trianglePoints(const SurfaceLanes& surface)
{
    return surface.terminatorLanes ? surface.onTriangle : surface.position;
}

/// Puts the positions of lanes back onto their triangles.
inline void dropTerminatorOffset(SurfaceLanes& surface, LaneMask lanes)
{
    for (const int i : lanesIn(surface.terminatorLanes & lanes))
        setLane(surface.position, i, plainOf(surface.onTriangle, i));
    surface.terminatorLanes &= ~lanes;
}

/// The triangle that all hits of an earlier block were on: the next one is often on the same. Of
/// one scene.
struct LastTriangle
{
    uint32_t geometry = kInvalid, instance = kInvalid, primitive = kInvalid; ///< Embree's
    uint32_t sceneInstance, material;
    bool smooth, mirrored;
    TrianglePlane plane;
    TriangleLanes lanes; ///< in the first lane; in all if smooth
};

/// The surfaces at the hits of block's active lanes. Lanes without a hit are zero where they are
/// floats. A point is k * 2^-24 * sum(max |vertex coordinate| * |normal|) off its triangle at most;
/// k = 32 leaves 1.5e-6 false hits at worst, and none on translated scenes (measured with
/// Embree 3.13.5). Added to it is Embree's own error of the distance to the plane, 8 * 2^-24 *
/// longest edge: a plane through the origin has no coordinates to err by.
///
/// RayStart::Smooth is against the terminator of the facets, which shows where the shading normals
/// still see a light that the facet turns its back to: where the light is, for these lanes, is a
/// matter of the shading normal alone. Flat facets and hollow sides have no terminator offset.
///
/// last: makes it cheaper for blocks of neighbouring rays, and changes nothing else; null: for a
/// block alone.
void surfacesOf(const SurfaceTable& table, const RayHitBlock& block, LaneMask active,
                SurfaceLanes& surface, RayStart start = RayStart::Triangle,
                LastTriangle* last = nullptr);

/// The shading normal turned to the side that the ray comes from; the geometric normal where the
/// two disagree so much that the ray would come from behind. Of all lanes, those without a hit
/// included.
void facingNormalLanes(const RayBlock& ray, const SurfaceLanes& surface, Vec3Lanes& normal);

} // namespace osgRayTrace::engine
