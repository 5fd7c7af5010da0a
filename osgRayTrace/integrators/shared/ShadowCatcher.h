// ShadowCatcher.h - the shadows on the ground, as rays from the eye see them. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/integrators/shared/Integrator.h"

namespace osgRayTrace::engine
{

/// The rays of a block that pass the ground where it is in shadow.
struct CaughtShadows
{
    LaneMask lanes = 0;
    FloatLanes share; ///< estimate of the ground's light over its light without anything around;
                      ///< single estimates may be negative, their mean is not
};

/// The rays of a block that come from the eye, straight or by mirrors and clear glass alone.
struct CatchingRays
{
    const RayHitBlock& rays; ///< after the query for their closest hits
    LaneMask active;
    const UintLanes& seeds; ///< seeds of the rays, or of the pixels
    uint32_t number;        ///< tells rays of equal seeds apart
};

/// Finds the active rays that come down through the ground before their hits, and estimates what
/// the shadow there leaves of what stands behind the ground. The ground shows nothing else, and no
/// other rays meet it. Scenes without SceneTraits::ground need no call. Counts shadow rays.
void catchShadows(const PassContext& context, const CatchingRays& rays, TileCounts& counts,
                  CaughtShadows& caught);

} // namespace osgRayTrace::engine
