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

OSGRAYTRACE_INLINE PlainVec3 plainOrigin(const RayBlock& ray, int i)
{
    return {ray.originX[i], ray.originY[i], ray.originZ[i]};
}

OSGRAYTRACE_INLINE PlainVec3 plainDirection(const RayBlock& ray, int i)
{
    return {ray.directionX[i], ray.directionY[i], ray.directionZ[i]};
}

/// Sets all of lane i.
OSGRAYTRACE_INLINE void setRay(RayBlock& ray, int i, PlainVec3 origin, PlainVec3 direction,
                               float tNear, float tFar)
{
    ray.originX[i] = origin.x;
    ray.originY[i] = origin.y;
    ray.originZ[i] = origin.z;
    ray.tNear[i] = tNear;
    ray.directionX[i] = direction.x;
    ray.directionY[i] = direction.y;
    ray.directionZ[i] = direction.z;
    ray.time[i] = 0.0f;
    ray.tFar[i] = tFar;
    ray.mask[i] = 0xffffffffu;
    ray.id[i] = 0;
    ray.flags[i] = 0;
}

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
