// ShadowLanes.h - light samples of surface points, and shadow rays. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/shading/LightTable.h"

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

/// Surface points that ask for a light sample.
struct LightReceivers
{
    const SurfaceLanes& surface;
    LaneMask active;
    LaneMask throughSurface; ///< lanes that get light from behind the surface, too
    const FloatLanes &u, &v; ///< the point on the light
};

/// Sets samples at point (u, v) of area light number light for the active receivers. Lanes whose
/// geometric normal faces away from the light are left out unless throughSurface has them. pmf is
/// the probability with which each lane chose this light.
void areaLightLanes(const PassContext& context, uint32_t light, float pmf,
                    const LightReceivers& receivers, LightLanes& samples);

/// Sets samples as areaLightLanes does, of a directional, point or spot light. u and v are not read
/// if the light has no size.
void deltaLightLanes(const PassContext& context, uint32_t light, const LightReceivers& receivers,
                     LightLanes& samples);

/// Returns the lanes of samples.lit that see the light, and counts their shadow rays.
LaneMask visibleLanes(const PassContext& context, LightLanes& samples, TileCounts& counts);

/// Returns the lanes that see a directional, point or spot light. No rays are traced if the light
/// casts no shadows.
LaneMask visibleLanes(const PassContext& context, const Light& light, LightLanes& samples,
                      TileCounts& counts);

} // namespace osgRayTrace::engine
