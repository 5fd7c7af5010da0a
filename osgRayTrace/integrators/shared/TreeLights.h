// TreeLights.h - light samples of surface points on lights that a tree chooses. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/ShadowLanes.h"

namespace osgRayTrace::engine
{

/// The surface points of a block as a LightTree sees them.
struct TreePoints
{
    Vec3Lanes position;
    Vec3Lanes normal; ///< 0 in lanes that get light from both sides
};

/// The samples that a block of surface points takes of a LightTree, one for each lane.
struct TreeSamples
{
    LightLanes lights;   ///< weight: with the probability of the choice, and shared by all picks
    UintLanes emitters;  ///< numbers of the chosen emitters
    FloatLanes pmf;      ///< probabilities of the choices, times the number of picks
    LaneMask points = 0; ///< lanes whose emitter is a point light, which no path meets by chance
};

/// Returns the points for which a tree is asked. normal: on the side of the ray.
TreePoints treePoints(const SurfaceLanes& surface, const Vec3Lanes& normal,
                      LaneMask throughSurface);

/// A point on an emitter that is no point light, evenly spread by area.
struct EmitterPoint
{
    Vec3 position, normal; ///< the normal is unit, of the front
    float offset;          ///< see Quad
    Vec3 radiance;
};
EmitterPoint emitterPoint(const PassContext& context, const LightEmitter& emitter, float u,
                          float v);

/// Sets the samples of the emitters that a tree has chosen for each lane, at point (u, v) of
/// receivers. picks: number of samples that the points take. There must be a tree.
void treeLightLanes(const PassContext& context, const SceneLightTree::Pick& chosen, float picks,
                    const LightReceivers& receivers, TreeSamples& samples);

/// Chooses an emitter in each lane by choice, in [0,1), and sets its sample.
void treeLightLanes(const PassContext& context, const TreePoints& points, const FloatLanes& choice,
                    float picks, const LightReceivers& receivers, TreeSamples& samples);

/// Returns the lanes of samples.lights.lit that see their light, and counts their shadow rays. No
/// rays are traced to lights without shadows.
LaneMask visibleLanes(const PassContext& context, TreeSamples& samples, TileCounts& counts);

} // namespace osgRayTrace::engine
