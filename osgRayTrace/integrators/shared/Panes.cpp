// Panes.cpp - rays through thin walls and bodies that absorb. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/Panes.h"

#include "osgRayTrace/accel/MergeHits.h"
#include "osgRayTrace/accel/NormalMaps.h"
#include "osgRayTrace/accel/PaneCrossings.h"
#include "osgRayTrace/integrators/shared/ShadowLanes.h"
#include "osgRayTrace/sampling/Hash.h"
#include "osgRayTrace/shading/PaneLanes.h"

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

/// Sets the shares of the light that passes the surfaces of the lanes straight; others are
/// undefined.
void paneShares(const PassContext& context, const RayHitBlock& hits, const SurfaceLanes& surface,
                LaneMask lanes, Vec3Lanes& shares)
{
    const uint32_t material = surface.material[firstLane(lanes)];
    bool alike = true;
    for (const int i : lanesIn(lanes))
        alike = alike && surface.material[i] == material;
    const MaterialRecord& record = context.traced->materials()[material];
    if (alike && record.pane && record.constant && isClearPane(record.front))
    {
        const RayBlock& ray = hits.ray;
        const IncidentLanes incident{ray.directionX, ray.directionY, ray.directionZ,
                                     surface.shadingNormal};
        return clearPaneLanes(record.front, incident, shares);
    }
    for (const int i : lanesIn(lanes))
        setLane(shares, i, paneAt(context, hits, surface, i));
}

/// Multiplies the light of the lanes by their shares. Returns the lanes that keep some.
OSGRAYTRACE_KERNEL
LaneMask multiplyLight(const Vec3Lanes& shares, LaneMask lanes, LightLanes& samples)
{
    const LaneMask tinted = samples.tinted;
    FloatLanes &r = samples.radiance[0], &g = samples.radiance[1], &b = samples.radiance[2];
    Vec3Lanes& tint = samples.tint;
    LaneMask kept = 0;
    OSGRAYTRACE_SIMD_OR(kept)
    for (int i = 0; i < kLanes; ++i)
    {
        const uint32_t use = laneBit(lanes, i), again = laneBit(tinted, i);
        const float x = select(use, shares.x[i], 1.0f), y = select(use, shares.y[i], 1.0f),
                    z = select(use, shares.z[i], 1.0f);
        r[i] *= x;
        g[i] *= y;
        b[i] *= z;
        tint.x[i] = select(again, tint.x[i], 1.0f) * x;
        tint.y[i] = select(again, tint.y[i], 1.0f) * y;
        tint.z[i] = select(again, tint.z[i], 1.0f) * z;
        kept |= bitOfLane(use & maskOf(x + y + z > 0.0f), i);
    }
    samples.tinted = tinted | kept;
    return kept;
}

/// Multiplies the light of the lanes by what the panes that their rays have met let through.
/// Returns the lanes that keep some.
LaneMask tintLight(const PassContext& context, const RayHitBlock& hits, LaneMask lanes,
                   LightLanes& samples)
{
    SurfaceLanes surface;
    surfacesOf(context.traced->surfaces(), hits, lanes, surface);
    if (context.traced->traits().normalMaps) applyNormalMaps(*context.traced, hits, surface);
    if (!surface.hits) return 0;
    Vec3Lanes shares;
    paneShares(context, hits, surface, surface.hits, shares);
    return multiplyLight(shares, surface.hits, samples);
}

/// Returns the lanes that see the light through any number of panes, one query for each.
LaneMask visibleBehindMore(const PassContext& context, LaneMask open, LightLanes& samples,
                           TileCounts& counts)
{
    RayHitBlock rays;
    rays.ray = samples.shadow;
    LaneMask visible = 0;
    for (int panes = 0; panes < kMostPanes && open; ++panes)
    {
        const LaneMask refused = context.traced->intersector().closestHits(
            rays, open, Coherence::Incoherent, kShadowRays);
        counts.shadowRays += static_cast<uint64_t>(countLanes(open));
        LaneMask met = 0;
        for (const int i : lanesIn(open & ~refused))
            (rays.geometry[i] == kInvalid ? visible : met) |= 1u << i;
        open = tintLight(context, rays, met, samples);
        for (const int i : lanesIn(open))
        {
            goOnBehind(rays.ray, i, samples.shadow.tFar[i]);
            if (rays.ray.tNear[i] < rays.ray.tFar[i]) continue;
            visible |= 1u << i;
            open &= ~(1u << i);
        }
    }
    return visible;
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
    const FloatLanes ends = samples.shadow.tFar;
    PaneCrossings crossings;
    context.traced->intersector().occlusion(samples.shadow, samples.lit, coherence, &crossings);
    counts.shadowRays += static_cast<uint64_t>(countLanes(samples.lit));
    samples.tinted = 0;
    LaneMask visible = unoccludedLanes(samples.shadow) & samples.lit;
    for (int k = 0; k < kMostCrossings; ++k)
    {
        const LaneMask passed = visible & crossings.beyond(k);
        if (!passed) break;
        RayHitBlock hits;
        crossings.hits(k, samples.shadow, hits);
        visible &= ~(passed & ~tintLight(context, hits, passed, samples));
    }
    const LaneMask more = crossings.full() & samples.lit;
    samples.shadow.tFar = ends;
    return more ? visible | visibleBehindMore(context, more, samples, counts) : visible;
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
