// EnvironmentLanes.h - environment samples of a block of surface points. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/ShadowLanes.h"

namespace osgRayTrace::engine
{

/// A direction towards the environment for the lanes of active, by Importance or Uniform. Lanes are
/// left out as in areaLightLanes.
void environmentLanes(const PassContext& context, const SurfaceLanes& surface, LaneMask active,
                      LaneMask throughSurface, const FloatLanes& u, const FloatLanes& v,
                      LightLanes& samples);

/// The same towards one stratum; inversePmf: over the probability with which the lanes chose it.
void stratumLanes(const EnvironmentStratum& stratum, float inversePmf, const SurfaceLanes& surface,
                  LaneMask active, LaneMask throughSurface, LightLanes& samples);

/// [1/sr] with which environmentLanes finds a direction.
float environmentPdfW(const PassContext& context, const PlacedEnvironment& environment,
                      Vec3 direction);

/// What a ray sees that missed everything and came from the eye by mirrors and glass alone. The
/// background if there is no environment.
Vec3 radianceBehind(const PassContext& context, const RayBlock& ray, int i);

/// The environment that camera rays see if they miss everything; null: they see the clear colour.
const PlacedEnvironment* visibleEnvironment(const PassContext& context);

} // namespace osgRayTrace::engine
