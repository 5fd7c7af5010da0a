// FogLanes.h - OpenGL's fog on what the eye sees. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/accel/SurfaceLanes.h"
#include "osgRayTrace/integrators/shared/PassContext.h"

namespace osgRayTrace::engine
{

/// What fog does to the surfaces of a block: a lane keeps share of its radiance and gets added.
struct FogLanes
{
    LaneMask lanes = 0; ///< lanes with fog; the other members are set in them alone
    FloatLanes share;
    Vec3Lanes added;
};

/// The rays of a block on their way to fogged surfaces. Fog is between the eye and what it sees; it
/// takes no light from shadow rays, and none from rays that a rough surface has scattered.
struct FogRays
{
    const RayHitBlock& rays;
    const SurfaceLanes& surface;
    LaneMask fromCamera; ///< rays from the eye, also those that go on behind blended surfaces
    LaneMask mirrored;   ///< rays that mirrors and smooth glass alone have turned
};

/// Sets the fog of the hits, and moves depths to them: depths hold how far the eye is from the
/// start of mirrored rays, along the way [engine units], and are not read for rays from the eye.
///
/// OpenGL mixes c' = f c + (1 - f) c_f with the depth of the surface [OpenGL21, sect. 3.10]. What
/// is seen in a mirror is as far as the way over the mirror is long. The mirror has its own fog
/// already, so that the rest of the way keeps the share f(whole way) / f(way to the mirror).
/// Scenes without SceneTraits::fog need no call.
void fogOf(const PassContext& context, const FogRays& rays, FloatLanes& depths, FogLanes& fog);

} // namespace osgRayTrace::engine
