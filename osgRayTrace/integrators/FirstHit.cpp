// FirstHit.cpp - geometry and material seen through the pixel centres. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/FirstHit.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/CameraLanes.h"
#include "osgRayTrace/integrators/HitShading.h"

namespace osgRayTrace::engine
{

namespace
{

/// GGX of width alpha falls to a quarter at tan(angle) = alpha [Walter07, eq. 33].
float lobeWidth(const MaterialRecord& record, const Bsdf& bsdf)
{
    if (record.material->blended) return 0.0f; // what is behind moves otherwise
    if (bsdf.isDiffuse()) return kInfinity;
    return bsdf.isSmooth() ? 0.0f : bsdf.alpha;
}

void setMaterial(const PassContext& context, const RayHitBlock& rays, const SurfaceLanes& surface, int i,
                 FirstHit& hit)
{
    const MaterialRecord& record = context.traced->materials()[surface.material[i]];
    const auto set = [&](const Bsdf& bsdf)
    {
        hit.albedo = bsdfAlbedo(bsdf);
        hit.lobe = lobeWidth(record, bsdf);
        hit.smooth = bsdf.isSmooth() && !bsdf.isDiffuse() && bsdf.diffuse == Vec3(0.0f);
    };
    if (record.constant) return set((surface.front >> i) & 1u ? record.front : record.back);
    set(context.traced->materials().bsdf(surface.material[i], materialPoint(context, rays, surface, i)));
}

/// All but the albedo.
void traceCentres(const PassContext& context, int left, int bottom, int block, FirstHitLanes& hits)
{
    centreRayLanes(context.camera, left, bottom, block, hits.rays);
    context.traced->intersector().closestHits(hits.rays, kAllLanes, Coherence::Coherent, kCameraRays);
    surfacesOf(context.traced->surfaces(), hits.rays, kAllLanes, hits.surface);
    facingNormalLanes(hits.rays.ray, hits.surface, hits.normal);
}

/// Blocks see few materials, most of which have the same albedo wherever they are seen.
void albedoLanes(const PassContext& context, const FirstHitLanes& hits, Vec3Lanes& albedo)
{
    const MaterialTable& materials = context.traced->materials();
    const SurfaceLanes& surface = hits.surface;
    uint32_t known = kInvalid;
    bool knownFront = false;
    Vec3 value(0.0f);
    for (int i = 0; i < kLanes; ++i)
    {
        if (!((surface.hits >> i) & 1u))
        {
            setLane(albedo, i, Vec3(0.0f));
            continue;
        }
        const uint32_t material = surface.material[i];
        const bool front = (surface.front >> i) & 1u;
        if (material != known || front != knownFront)
        {
            value = bsdfAlbedo(materials.bsdf(material, materialPoint(context, hits.rays, surface, i)));
            known = materials[material].constant ? material : kInvalid;
            knownFront = front;
        }
        setLane(albedo, i, value);
    }
}

} // namespace

void firstHitLanes(const PassContext& context, int left, int bottom, int block, FirstHitLanes& hits)
{
    traceCentres(context, left, bottom, block, hits);
    albedoLanes(context, hits, hits.albedo);
}

void firstHits(const PassContext& context, int left, int bottom, FirstHit (&hits)[kTilePixels])
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        FirstHitLanes block;
        traceCentres(context, left, bottom, b, block);
        const SurfaceLanes& surface = block.surface;
        for (int i = 0; i < kLanes; ++i)
        {
            FirstHit& hit = hits[b * kLanes + i];
            hit = FirstHit();
            if (!((surface.hits >> i) & 1u)) continue;
            hit.hit = true;
            hit.distance = block.rays.ray.tFar[i];
            hit.normal = laneOf(block.normal, i);
            setMaterial(context, block.rays, surface, i, hit);
            hit.emits = emissionTowardsRay(context, block.rays, surface, i) != Vec3(0.0f);
            hit.position = laneOf(surface.position, i);
            hit.instance = surface.instance[i];
        }
    }
}

} // namespace osgRayTrace::engine
