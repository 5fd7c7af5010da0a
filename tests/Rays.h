// Rays.h - rays for blocks of sixteen. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"

namespace osgRayTrace::engine::test
{

inline void setRay(RayBlock& block, int lane, Vec3 origin, Vec3 direction, float tNear = 0.0f,
                   float tFar = kInfinity)
{
    block.originX[lane] = origin.x;
    block.originY[lane] = origin.y;
    block.originZ[lane] = origin.z;
    block.directionX[lane] = direction.x;
    block.directionY[lane] = direction.y;
    block.directionZ[lane] = direction.z;
    block.tNear[lane] = tNear;
    block.tFar[lane] = tFar;
    block.time[lane] = 0.0f;
    block.mask[lane] = 0xffffffffu;
    block.id[lane] = block.flags[lane] = 0;
}

} // namespace osgRayTrace::engine::test
