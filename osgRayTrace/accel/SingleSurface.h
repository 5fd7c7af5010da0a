// SingleSurface.h - what is known of the point that one ray has hit. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/accel/TracedScene.h"

namespace osgRayTrace::engine
{

/// Holds the hit of one ray in the first lane of a block.
struct SingleSurface
{
    SingleSurface(const TracedScene& traced, Vec3 origin, Vec3 direction, const Hit& hit)
    {
        for (int i = 0; i < kLanes; ++i)
        {
            setRay(block.ray, i, plainOf(origin), plainOf(direction), 0.0f, hit.t);
            block.geometry[i] = block.instance[i] = kInvalid;
            block.primitive[i] = 0;
            block.u[i] = block.v[i] = 0.0f;
        }
        block.geometry[0] = hit.instance; // see hitInstance
        block.primitive[0] = hit.primitive;
        block.u[0] = hit.u;
        block.v[0] = hit.v;
        surfacesOf(traced.surfaces(), block, 1u, surface);
    }

    bool isFront() const { return (surface.front & 1u) != 0; }

    RayHitBlock block;
    SurfaceLanes surface;
};

} // namespace osgRayTrace::engine
