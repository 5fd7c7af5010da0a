// Panes.cpp - rays through thin walls and bodies that absorb. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/Panes.h"

#include "osgRayTrace/accel/MergeHits.h"
#include "osgRayTrace/accel/NormalMaps.h"
#include "osgRayTrace/sampling/Hash.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kMostPanes = 64; ///< one behind the other; the next one stops all rays

/// Returns the share that passes the surface of lane i straight; 0 unless it is a pane.
Vec3 paneAt(const PassContext& context, const RayHitBlock& rays, const SurfaceLanes& surface, int i)
{
    const MaterialTable& materials = context.traced->materials();
    const uint32_t material = surface.material[i];
    if (!materials[material].pane) return Vec3(0.0f);
    const float cosine =
        std::fabs(glm::dot(laneOf(surface.shadingNormal, i), directionOf(rays.ray, i)));
    return materials.pane(material, materialPoint(context, rays, surface, i), cosine);
}

/// Returns a number in [0, 1) that depends on the ray and the triangle alone.
float chance(const RayHitBlock& rays, const SurfaceLanes& surface, int i)
{
    const RayBlock& ray = rays.ray;
    const float numbers[] = {ray.originX[i],    ray.originY[i],    ray.originZ[i],
                             ray.directionX[i], ray.directionY[i], ray.directionZ[i]};
    uint32_t key = hash(surface.instance[i] + 0x70616e65u, rays.primitive[i]);
    for (const float number : numbers)
    {
        uint32_t bits;
        std::memcpy(&bits, &number, sizeof bits);
        key = hash(key, bits);
    }
    return unitFloat(key);
}

void goOnBehind(RayBlock& ray, int i, float tFar)
{
    ray.tNear[i] = std::nextafter(ray.tFar[i], kInfinity);
    ray.tFar[i] = tFar;
}

/// Sets the surfaces behind the panes that rays have passed.
void meetBehind(const PassContext& context, const PaneRays& lanes, LaneMask passed)
{
    for (const int i : lanesIn(passed))
        goOnBehind(lanes.rays.ray, i, kInfinity);
    RayHitBlock behind;
    behind.ray = lanes.rays.ray;
    context.traced->intersector().closestHits(behind, passed, Coherence::Incoherent, lanes.rule);
    SurfaceLanes surface;
    surfacesOf(context.traced->surfaces(), behind, passed, surface, rayStart(context.options));
    if (context.traced->traits().normalMaps) applyNormalMaps(*context.traced, behind, surface);
    mergeHits(behind, surface, passed, lanes.rays, lanes.surface);
}

} // namespace

bool goesThroughPane(const PassContext& context, const RayHitBlock& rays,
                     const SurfaceLanes& surface, int i, Vec3Lanes& throughput)
{
    const Vec3 share = paneAt(context, rays, surface, i);
    const float p = std::min(std::max(share.x, std::max(share.y, share.z)), 1.0f);
    if (!(p > 0.0f)) return false;
    const bool goesOn = p > 1.0f - 1e-6f || chance(rays, surface, i) < p;
    const Vec3 weight = goesOn ? share / p : Vec3(1.0f / (1.0f - p));
    setLane(throughput, i, laneOf(throughput, i) * weight);
    return goesOn;
}

LaneMask passPanes(const PassContext& context, const PaneRays& lanes, TileCounts& counts)
{
    LaneMask open = lanes.active, all = 0;
    for (int panes = 0; panes < kMostPanes; ++panes)
    {
        LaneMask passed = 0;
        for (const int i : lanesIn(open & lanes.surface.hits))
        {
            const bool goesOn =
                goesThroughPane(context, lanes.rays, lanes.surface, i, lanes.throughput);
            passed |= static_cast<LaneMask>(goesOn) << i;
        }
        if (!passed) return all;
        all |= passed;
        meetBehind(context, lanes, passed);
        counts.secondaryRays += static_cast<uint64_t>(countLanes(passed));
        open = passed;
    }
    return all;
}

LaneMask visibleThroughPanes(const PassContext& context, LightLanes& samples, TileCounts& counts,
                             Coherence coherence)
{
    const RayBlock& shadow = samples.shadow;
    RayHitBlock rays;
    rays.ray = shadow;
    samples.tinted = 0;
    LaneMask open = samples.lit, visible = 0;
    for (int panes = 0; panes < kMostPanes && open; ++panes)
    {
        context.traced->intersector().closestHits(
            rays, open, panes == 0 ? coherence : Coherence::Incoherent, kShadowRays);
        counts.shadowRays += static_cast<uint64_t>(countLanes(open));
        SurfaceLanes surface;
        surfacesOf(context.traced->surfaces(), rays, open, surface);
        if (context.traced->traits().normalMaps) applyNormalMaps(*context.traced, rays, surface);
        visible |= open & ~surface.hits;
        open &= surface.hits;
        for (const int i : lanesIn(open))
        {
            const Vec3 share = paneAt(context, rays, surface, i);
            if (share == Vec3(0.0f))
            {
                open &= ~(1u << i);
                continue;
            }
            for (int c = 0; c < 3; ++c)
                samples.radiance[c][i] *= share[c];
            setLane(samples.tint, i,
                    ((samples.tinted >> i) & 1u ? laneOf(samples.tint, i) : Vec3(1.0f)) * share);
            samples.tinted |= 1u << i;
            goOnBehind(rays.ray, i, shadow.tFar[i]);
            if (!(rays.ray.tNear[i] < rays.ray.tFar[i]))
            {
                visible |= 1u << i;
                open &= ~(1u << i);
            }
        }
    }
    return visible;
}

LaneMask attenuate(const PassContext& context, const RayHitBlock& rays, const SurfaceLanes& surface,
                   Vec3Lanes& throughput)
{
    const MaterialTable& materials = context.traced->materials();
    LaneMask changed = 0;
    for (const int i : lanesIn(surface.hits & ~surface.front))
    {
        const MaterialRecord& record = materials[surface.material[i]];
        if (!record.absorbs || record.interface) continue; // media beyond interfaces: addAir
        setLane(throughput, i, laneOf(throughput, i) * transmittanceOver(record, rays.ray.tFar[i]));
        changed |= 1u << i;
    }
    return changed;
}

} // namespace osgRayTrace::engine
