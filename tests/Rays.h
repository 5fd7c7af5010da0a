// Rays.h - rays for blocks of sixteen. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"

namespace osgRayTrace::engine::test
{

inline void setRay(RayBlock& block, int lane, Vec3 origin, Vec3 direction, float tNear = 0.0f,
                   float tFar = kInfinity)
{
    engine::setRay(block, lane, plainOf(origin), plainOf(direction), tNear, tFar);
}

} // namespace osgRayTrace::engine::test
