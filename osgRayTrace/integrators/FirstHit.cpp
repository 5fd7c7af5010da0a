// FirstHit.cpp - geometry and material seen through the pixel centres. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/FirstHit.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/CameraLanes.h"
#include "osgRayTrace/integrators/HitShading.h"

namespace osgRayTrace::engine
{

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
            hit.smooth = bsdf.isSmooth() && !bsdf.isDiffuse() && bsdf.diffuse == Vec3(0.0f);
            hit.emits = emissionTowardsRay(context, rays, surface, i) != Vec3(0.0f);
            hit.position = laneOf(surface.position, i);
            hit.instance = surface.instance[i];
        }
    }
}

} // namespace osgRayTrace::engine
