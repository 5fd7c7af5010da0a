// RayBlock.h - sixteen rays and their hits, laid out as Embree's packets. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Math.h"

namespace osgRayTrace::engine
{

/// Rays of occlusion queries: origin + t*direction for t in [tNear, tFar], direction of length
/// about 1. After the query tFar is -infinity where something is in the way.
struct RayBlock
{
    FloatLanes originX, originY, originZ;
    FloatLanes tNear;
    FloatLanes directionX, directionY, directionZ;
    FloatLanes time;
    FloatLanes tFar;
    UintLanes mask, id, flags;
};

/// Rays of closest-hit queries with their hits. primitive, geometry and instance are Embree's; use
/// hitInstance(). geometry == kInvalid: no hit.
struct RayHitBlock
{
    RayBlock ray;
    FloatLanes normalX, normalY, normalZ; ///< Embree's, not unit: not used
    FloatLanes u, v;                      ///< barycentric weights of vertices 1 and 2
    UintLanes primitive;                  ///< triangle index within its mesh
    UintLanes geometry;
    UintLanes instance;
};

/// Index into Scene::instances of the surface hit: instances are attached by their own index, those
/// that are placed by a transform as instances.
OSGRAYTRACE_INLINE uint32_t hitInstance(uint32_t embreeGeometry, uint32_t embreeInstance)
{
    return embreeInstance != kInvalid ? embreeInstance : embreeGeometry;
}

} // namespace osgRayTrace::engine
