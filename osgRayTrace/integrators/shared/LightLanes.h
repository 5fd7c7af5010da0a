// LightLanes.h - light samples of a block of surface points. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"

namespace osgRayTrace::engine
{

/// One light sample for each lane.
struct LightLanes
{
    Vec3Lanes wi;           ///< unit direction towards the light
    FloatLanes radiance[3]; ///< towards the surface; of a delta light pi * colour * attenuation
    FloatLanes weight; ///< factor of f cos: 1 / (pmf of the light's choice * pdfW); 1 for delta
                       ///< lights without a size
    FloatLanes attenuation; ///< attenuation of delta lights, already in radiance
    Vec3Lanes tint;         ///< share that panes let through, already in radiance; see tinted
    LaneMask tinted = 0;    ///< lanes whose light has come through panes
    LaneMask lit = 0;       ///< lanes that can get light; other lanes are undefined
    RayBlock shadow; ///< ray from the surface to the light, both ends clear of their own geometry
};

inline void setSample(LightLanes& samples, int i, Vec3 wi, Vec3 radiance, float weight)
{
    setLane(samples.wi, i, wi);
    for (int c = 0; c < 3; ++c)
        samples.radiance[c][i] = radiance[c];
    samples.weight[i] = weight;
}

} // namespace osgRayTrace::engine
