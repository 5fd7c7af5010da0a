// MergeHits.cpp - takes lanes of a block over into another one. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/MergeHits.h"

namespace osgRayTrace::engine
{

static LaneMask merged(LaneMask later, LaneMask lanes, LaneMask mask)
{
    return (later & lanes) | (mask & ~lanes);
}

void mergeHits(const RayHitBlock& later, const SurfaceLanes& laterSurface, LaneMask lanes,
               RayHitBlock& rays, SurfaceLanes& surface)
{
    if (!surface.terminatorLanes) surface.onTriangle = surface.position;
    const Vec3Lanes& points = trianglePoints(laterSurface);
    for (const int i : lanesIn(lanes))
    {
        rays.ray.tFar[i] = later.ray.tFar[i];
        rays.u[i] = later.u[i];
        rays.v[i] = later.v[i];
        rays.primitive[i] = later.primitive[i];
        rays.geometry[i] = later.geometry[i];
        rays.instance[i] = later.instance[i];
        setLane(surface.position, i, plainOf(laterSurface.position, i));
        setLane(surface.geometricNormal, i, plainOf(laterSurface.geometricNormal, i));
        setLane(surface.shadingNormal, i, plainOf(laterSurface.shadingNormal, i));
        setLane(surface.unmappedNormal, i, plainOf(laterSurface.unmappedNormal, i));
        setLane(surface.onTriangle, i, plainOf(points, i));
        surface.offset[i] = laterSurface.offset[i];
        surface.minCosine[i] = laterSurface.minCosine[i];
        surface.instance[i] = laterSurface.instance[i];
        surface.material[i] = laterSurface.material[i];
    }
    surface.hits = merged(laterSurface.hits, lanes, surface.hits);
    surface.coned &= ~lanes;
    surface.front = merged(laterSurface.front, lanes, surface.front);
    surface.terminatorLanes = merged(laterSurface.terminatorLanes, lanes, surface.terminatorLanes);
}

} // namespace osgRayTrace::engine
