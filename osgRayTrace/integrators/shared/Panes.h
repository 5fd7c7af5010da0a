// Panes.h - light that passes thin walls straight, and what bodies absorb. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/HitRule.h"
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/LightLanes.h"

namespace osgRayTrace::engine
{

/// A ray with its throughput, for passPanes.
struct PaneRays
{
    RayHitBlock& rays;
    LaneMask active;
    HitRule rule;
    SurfaceLanes& surface; ///< surfaces that the rays met, and then those that they stop at
    Vec3Lanes& throughput;
};

/// Lets rays pass panes: of light that meets a pane, the share T passes straight. With probability
/// p, the largest component of T, a ray goes on to what is behind the pane with throughput T / p,
/// else it stays with throughput 1 / (1 - p), and the caller has to leave out the straight lobe:
/// dropStraightLobe. A ray that goes on keeps its origin, its distance and all densities, so that
/// light samples, whose shadow rays pass panes as well, and rays that meet lights weigh the same
/// light. Returns the lanes that have passed some pane. Scenes without SceneTraits::panes need no
/// call.
LaneMask passPanes(const PassContext& context, const PaneRays& lanes, TileCounts& counts);

/// Lets the ray of lane i pass a pane as passPanes does, or returns false: it stays there. Changes
/// its throughput in both cases.
bool goesThroughPane(const PassContext& context, const RayHitBlock& rays,
                     const SurfaceLanes& surface, int i, Vec3Lanes& throughput);

/// Leaves out the lobe that passPanes has taken.
inline void dropStraightLobe(Bsdf& bsdf)
{
    if (bsdf.thin && bsdf.isSmooth()) bsdf.transmission = Vec3(0.0f);
}

/// Returns the lit lanes that see the light, straight or through panes alone, and multiplies their
/// radiance by the share that passes. One query finds up to kMostCrossings panes of each ray; rays
/// that meet more of them are traced again, from pane to pane.
LaneMask visibleThroughPanes(const PassContext& context, LightLanes& samples, TileCounts& counts,
                             Coherence coherence);

/// Multiplies throughput by what is left of light that has come through the bodies whose inner
/// sides the rays met: exp(-absorption distance), Beer's law. A ray that ends at something within a
/// body, or at a pane, counts as outside. Returns the lanes that have changed. Scenes without
/// SceneTraits::attenuation need no call.
LaneMask attenuate(const PassContext& context, const RayHitBlock& rays, const SurfaceLanes& surface,
                   Vec3Lanes& throughput);

} // namespace osgRayTrace::engine
