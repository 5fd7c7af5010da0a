// ShadowLanes.h - light samples of surface points, and shadow rays. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/LightLanes.h"
#include "osgRayTrace/shading/LightTable.h"

namespace osgRayTrace::engine
{

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
/// the probability with which each lane chose this light. leastAngle: rectangles that no lane sees
/// under so much are sampled by area [sr]; a greater one saves time, but samples then have other
/// densities than LightTable tells.
void areaLightLanes(const PassContext& context, uint32_t light, float pmf,
                    const LightReceivers& receivers, LightLanes& samples,
                    float leastAngle = kWideAngle);

/// Sets samples as areaLightLanes does, of a directional, point or spot light. u and v are not read
/// if the light has no size.
void deltaLightLanes(const PassContext& context, uint32_t light, const LightReceivers& receivers,
                     LightLanes& samples);

/// Sets the sample of one lane as deltaLightLanes does. Returns false if no light reaches the lane.
bool deltaLane(const PassContext& context, uint32_t light, const LightReceivers& receivers, int i,
               LightLanes& samples);

/// Returns the lanes whose rays Intersector::occlusion found to meet nothing.
LaneMask unoccludedLanes(const RayBlock& shadow);

/// Returns the lanes of samples.lit that see the light, and counts their shadow rays.
LaneMask visibleLanes(const PassContext& context, LightLanes& samples, TileCounts& counts,
                      Coherence coherence = Coherence::Incoherent);

/// Returns the lanes that see a directional, point or spot light. No rays are traced if the light
/// casts no shadows.
LaneMask visibleLanes(const PassContext& context, const Light& light, LightLanes& samples,
                      TileCounts& counts, Coherence coherence = Coherence::Incoherent);

} // namespace osgRayTrace::engine
