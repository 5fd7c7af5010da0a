// FogLanes.cpp - depths and shares of fog, lane by lane. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/FogLanes.h"

namespace osgRayTrace::engine
{

namespace
{

/// Returns the depth of the point of lane i along the view's axis [engine units].
float depthOf(const PassContext& context, const SurfaceLanes& surface, int i)
{
    return glm::dot(context.eye - laneOf(trianglePoints(surface), i), context.towardsViewer);
}

/// Returns the distance of the point of lane i by which the fog is mixed [engine units].
float foggedDistance(const PassContext& context, const Fog& fog, const SurfaceLanes& surface, int i)
{
    if (fog.radial) return glm::length(context.eye - laneOf(trianglePoints(surface), i));
    return depthOf(context, surface, i);
}

} // namespace

void fogOf(const PassContext& context, const FogRays& rays, FloatLanes& depths, FogLanes& fog)
{
    const TracedScene& traced = *context.traced;
    const auto unit = static_cast<float>(traced.scene().unit);
    fog.lanes = 0;
    for (const int i : lanesIn(rays.surface.hits & (rays.fromCamera | rays.mirrored)))
    {
        const bool fromCamera = (rays.fromCamera >> i) & 1u;
        const float start = fromCamera ? 0.0f : depths[i];
        const float end =
            fromCamera ? depthOf(context, rays.surface, i) : depths[i] + rays.rays.ray.tFar[i];
        depths[i] = end;
        const Fog& own = traced.materials()[rays.surface.material[i]].material->fog;
        if (own.mode == FogMode::None) continue;
        const float distance = fromCamera ? foggedDistance(context, own, rays.surface, i) : end;
        const float before = fromCamera ? 1.0f : fogShare(own, start * unit);
        const float share = before > 0.0f ? fogShare(own, distance * unit) / before : 0.0f;
        fog.lanes |= 1u << i;
        fog.share[i] = share;
        setLane(fog.added, i, own.color * (1.0f - share));
    }
}

} // namespace osgRayTrace::engine
