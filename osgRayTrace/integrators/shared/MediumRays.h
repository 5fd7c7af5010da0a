// MediumRays.h - what media leave of shadow rays. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Bodies.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/LightLanes.h"
#include "osgRayTrace/media/MediumTable.h"

namespace osgRayTrace::engine
{

/// Multiplies the radiance of visible samples by what media leave on the ways of their shadow rays:
/// exp(-sum of sigmaT length) over the stretches between the boundaries that do not block, and an
/// estimate of it for volumes. The scene has SceneTraits::media.
void dimByMedia(const PassContext& context, const MediumLanes& bodies, LaneMask visible,
                LightLanes& samples);

} // namespace osgRayTrace::engine
