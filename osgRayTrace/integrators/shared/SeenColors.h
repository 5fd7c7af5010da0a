// SeenColors.h - the colours of the surfaces that a block of rays hit. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/HitShading.h"

namespace osgRayTrace::engine
{

/// Sets colors to what the surfaces that camera rays met make of light of 1: bsdfAlbedo, and what
/// they emit on top, behind the fog if there is any. The colours are linear, also in a
/// display-referred scene, and 0 in lanes that hit nothing.
void seenColors(const PassContext& context, const RayHitBlock& rays, const SurfaceLanes& surface,
                Vec3Lanes& colors);

} // namespace osgRayTrace::engine
