// RayBlock.h - sixteen rays and their hits, laid out as Embree's packets. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Math.h"

namespace osgRayTrace::engine
{

/// The rays of occlusion queries: origin + t*direction for t in [tNear, tFar]. The directions have
/// a length of about 1. After the query tFar is -infinity in every lane whose ray is blocked.
struct RayBlock
{
    FloatLanes originX, originY, originZ;
    FloatLanes tNear;
    FloatLanes directionX, directionY, directionZ;
    FloatLanes time;
    FloatLanes tFar;
    UintLanes mask, id, flags;
};

/// Returns the origin of lane i.
OSGRAYTRACE_INLINE PlainVec3 plainOrigin(const RayBlock& ray, int i)
{
    return {ray.originX[i], ray.originY[i], ray.originZ[i]};
}

/// Returns the direction of lane i.
OSGRAYTRACE_INLINE PlainVec3 plainDirection(const RayBlock& ray, int i)
{
    return {ray.directionX[i], ray.directionY[i], ray.directionZ[i]};
}

/// Sets all fields of lane i.
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

/// The rays of closest-hit queries with their hits. The fields primitive, geometry and instance are
/// Embree's; hitInstance() turns them into an index of the scene. A lane whose geometry is kInvalid
/// has no hit.
struct RayHitBlock
{
    RayBlock ray;
    FloatLanes normalX, normalY, normalZ; ///< Embree's normal, not unit; not used
    FloatLanes u, v;                      ///< barycentric weights of vertices 1 and 2
    UintLanes primitive;                  ///< triangle index within its mesh
    UintLanes geometry;
    UintLanes instance;
};

/// Returns the index into Scene::instances of the surface that was hit. Every instance is attached
/// under its own index: as an Embree instance if a transform places it, as a geometry otherwise.
OSGRAYTRACE_INLINE uint32_t hitInstance(uint32_t embreeGeometry, uint32_t embreeInstance)
{
    return embreeInstance != kInvalid ? embreeInstance : embreeGeometry;
}

} // namespace osgRayTrace::engine
