// HitShading.cpp - material, frame and emission of single hits. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/HitShading.h"

#include "osgRayTrace/accel/SurfaceAttributes.h"

#include <cmath>

namespace osgRayTrace::engine
{

MaterialPoint materialPoint(const PassContext& context, const RayHitBlock& rays,
                            const SurfaceLanes& surface, int i)
{
    const bool front = (surface.front >> i) & 1u;
    const MaterialRecord& material = context.traced->materials()[surface.material[i]];
    if (material.constant)
    {
        MaterialPoint point;
        point.front = front;
        return point;
    }
    const Vec3 direction = directionOf(rays.ray, i);
    MaterialPoint point =
        materialPointOf(context.traced->surfaces()[surface.instance[i]], material,
                        rays.primitive[i], rays.u[i], rays.v[i], front, direction);
    if (material.generated) point.eyeFromEngine = context.eyeFromEngine;
    if (material.mipmapped && ((surface.coned >> i) & 1u))
        setTextureWidths(context.traced->surfaces()[surface.instance[i]], rays.primitive[i],
                         surface.footprint[i], point);
    return point;
}

Vec3 facingNormal(const RayHitBlock& rays, const SurfaceLanes& surface, int i)
{
    const Vec3 geometric = laneOf(surface.geometricNormal, i);
    Vec3 shading = laneOf(surface.shadingNormal, i);
    if (glm::dot(shading, geometric) < 0.0f) shading = -shading;
    const Vec3 direction = directionOf(rays.ray, i);
    return glm::dot(shading, direction) < -1e-4f ? shading : geometric;
}

Vec3 emissionTowardsRay(const PassContext& context, const RayHitBlock& rays,
                        const SurfaceLanes& surface, int i)
{
    const MaterialTable& materials = context.traced->materials();
    const uint32_t material = surface.material[i];
    if (!materials[material].emits) return Vec3(0.0f);
    const uint32_t light = context.traced->surfaces()[surface.instance[i]].light;
    if (light != kInvalid && !((surface.front >> i) & 1u))
    {
        const Light& l = (*context.lights)[light];
        if (l.kind == LightKind::Parallelogram && !l.twoSided) return Vec3(0.0f);
    }
    return materials.emission(material, materialPoint(context, rays, surface, i));
}

/// Radiances from this on count as infinite, because their sums could overflow.
constexpr float kLargestRadiance = 1e30f;

OSGRAYTRACE_KERNEL
static LaneMask finiteLanes(const RgbaLanes& rgba)
{
    LaneMask finite = 0;
    OSGRAYTRACE_SIMD_OR(finite)
    for (int i = 0; i < kLanes; ++i)
    {
        // Comparisons with NaN are false.
        const bool small = (std::fabs(rgba.r[i]) < kLargestRadiance) &
                           (std::fabs(rgba.g[i]) < kLargestRadiance) &
                           (std::fabs(rgba.b[i]) < kLargestRadiance);
        finite |= bitOfLane(maskOf(small), i);
    }
    return finite;
}

void dropNotFinite(TileResult& result)
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        RgbaLanes& rgba = result.rgba[b];
        for (const int i : lanesIn(~finiteLanes(rgba) & kAllLanes))
        {
            rgba.r[i] = rgba.g[i] = rgba.b[i] = 0.0f;
            ++result.counts.droppedSamples;
            if (result.debug) result.debug->dropped[b * kLanes + i] += 1.0f;
        }
    }
}

} // namespace osgRayTrace::engine
