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

} // namespace

void firstHits(const PassContext& context, int left, int bottom, FirstHit (&hits)[kTilePixels])
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        RayHitBlock rays;
        UintLanes seeds;
        SurfaceLanes surface;
        cameraRayLanes(context.camera, context.key, left, bottom, b, true, rays, seeds);
        context.traced->intersector().closestHits(rays, kAllLanes, Coherence::Coherent, kCameraRays);
        surfacesOf(context.traced->surfaces(), rays, kAllLanes, surface);
        Vec3Lanes normals;
        facingNormalLanes(rays.ray, surface, normals);
        for (int i = 0; i < kLanes; ++i)
        {
            FirstHit& hit = hits[b * kLanes + i];
            hit = FirstHit();
            if (!((surface.hits >> i) & 1u)) continue;
            hit.hit = true;
            hit.distance = rays.ray.tFar[i];
            hit.normal = laneOf(normals, i);
            setMaterial(context, rays, surface, i, hit);
            hit.emits = emissionTowardsRay(context, rays, surface, i) != Vec3(0.0f);
            hit.position = laneOf(surface.position, i);
            hit.instance = surface.instance[i];
        }
    }
}

} // namespace osgRayTrace::engine
