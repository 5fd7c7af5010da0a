// SurfaceLanes.h - the surface points of sixteen rays as columns. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"

namespace osgRayTrace::engine
{

/// The hit points, rebuilt from barycentric coordinates, with the bound of their rounding error.
struct SurfaceLanes
{
    Vec3Lanes position;        ///< point on the triangle; in terminatorLanes the start of rays
    Vec3Lanes geometricNormal; ///< unit, on the side that the ray comes from
    Vec3Lanes shadingNormal;   ///< unit; the mesh's own, not turned to either side
    FloatLanes offset;         ///< distance along geometricNormal that clears the error of position
    FloatLanes minCosine;      ///< cosine above which rays may begin at position itself: leave()
    UintLanes instance;        ///< index into Scene::instances; undefined outside of hits
    UintLanes material;        ///< index into Scene::materials
    FloatLanes footprint; ///< width of what the pixel sees here [engine units]; in lanes of coned
    LaneMask hits = 0;
    LaneMask coned = 0;           ///< lanes with a footprint: see setFootprints
    LaneMask front = 0;           ///< lanes whose ray meets the mesh's counter-clockwise side
    LaneMask terminatorLanes = 0; ///< hits whose position is above their triangle: see RayStart
    Vec3Lanes onTriangle;         ///< point without offset; unset without terminatorLanes
    Vec3Lanes unmappedNormal;     ///< shadingNormal before normal maps; see applyNormalMaps
};

/// Returns the points on the triangles, which are without terminator offsets.
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

} // namespace osgRayTrace::engine
