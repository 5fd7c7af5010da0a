// EnvironmentLanes.h - environment samples of a block of surface points. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/ShadowLanes.h"

namespace osgRayTrace::engine
{

/// Sets a sample of the environment for the active receivers, by Importance or Uniform sampling.
/// Lanes are left out as areaLightLanes leaves them out. Importance samples of lanes whose light
/// rays find by chance as well have EnvironmentDensity::Compensated; alone: the lanes whose samples
/// are all that finds this light, which have EnvironmentDensity::Luminance.
void environmentLanes(const PassContext& context, const LightReceivers& receivers, LaneMask alone,
                      LightLanes& samples);

/// A direction towards the environment.
struct SkySample
{
    Vec3 direction{0.0f, 0.0f, 1.0f};
    Vec3 radiance{0.0f};
    float pdfW = 0.0f; ///< [1/sr]
};

/// Returns a sample as environmentLanes takes it; alone: no ray finds this light by chance.
SkySample sampleSky(const PassContext& context, const PlacedEnvironment& environment, Vec2 u,
                    bool alone);

/// Sets samples as environmentLanes does, towards one stratum. inversePmf is 1 over the probability
/// with which the lanes chose the stratum.
void stratumLanes(const EnvironmentStratum& stratum, float inversePmf, const SurfaceLanes& surface,
                  LaneMask active, LaneMask throughSurface, LightLanes& samples);

/// Returns the density [1/sr] with which environmentLanes finds a direction in lanes that are not
/// alone.
float environmentPdfW(const PassContext& context, const PlacedEnvironment& environment,
                      Vec3 direction);

/// Returns the radiance that a ray sees if it missed everything and came from the eye by mirrors
/// and glass alone. Without an environment this is the background.
Vec3 radianceBehind(const PassContext& context, const RayBlock& ray, int i);

/// Returns the environment that camera rays see if they miss everything, or null if they see the
/// clear colour.
const PlacedEnvironment* visibleEnvironment(const PassContext& context);

} // namespace osgRayTrace::engine
