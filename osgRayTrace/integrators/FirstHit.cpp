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
        for (int i = 0; i < kLanes; ++i)
        {
            FirstHit& hit = hits[b * kLanes + i];
            hit = FirstHit();
            if (!((surface.hits >> i) & 1u)) continue;
            hit.hit = true;
            hit.distance = rays.ray.tFar[i];
            hit.normal = facingNormal(rays, surface, i);
            const MaterialPoint point = materialPoint(context, rays, surface, i);
            const MaterialTable& materials = context.traced->materials();
            const Bsdf bsdf = materials.bsdf(surface.material[i], point);
            hit.albedo = bsdfAlbedo(bsdf);
            hit.lobe = lobeWidth(materials[surface.material[i]], bsdf);
            hit.position = laneOf(surface.position, i);
            hit.instance = surface.instance[i];
        }
    }
}

} // namespace osgRayTrace::engine
