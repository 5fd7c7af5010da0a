// PathPhotons.cpp - what paths leave to photons, and get from them. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/HitShading.h"
#include "osgRayTrace/integrators/PathBounce.h"
#include "osgRayTrace/integrators/PhotonGather.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kGatherAlpha = 0.25f; ///< GGX width from which photons replace further bounces

} // namespace

void chooseGathering(Bounce& bounce, PhotonUse use)
{
    bounce.gathering = bounce.diffuse;
    bounce.ending = use == PhotonUse::Indirect ? bounce.diffuse : 0u;
    for (LaneMask lanes = bounce.general; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const Bsdf& bsdf = bounce.bsdfs[i];
        const bool lambert = bsdf.diffuse != Vec3(0.0f);
        const bool rough = lambert || bsdf.alpha >= kGatherAlpha;
        const bool scatters = lambert || !bsdf.isSmooth();
        if (use == PhotonUse::Indirect ? rough : scatters) bounce.gathering |= 1u << i;
        if (use == PhotonUse::Indirect && rough) bounce.ending |= 1u << i;
    }
}

/// Adds what the photons around the lanes' points send back along their rays. The radius belongs to
/// the pixel where light that the photons carry is seen directly; after a bounce it is the same for
/// all.
void addPhotons(Tile& tile, const PathBlock& block, const Bounce& bounce, PhotonUse use)
{
    const PhotonMap& map = *tile.context.photons;
    GatheredPhotons& gathered = *tile.result.gathered;
    const int edgesLeft = tile.context.options.maxBounces - bounce.number;
    for (LaneMask lanes = bounce.gathering; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const uint32_t pixel = block.pixel[i] & kPixelBits;
        GatherPoint point;
        point.query.position = laneOf(trianglePoints(bounce.surface), i);
        point.query.normal = laneOf(bounce.surface.geometricNormal, i);
        point.query.shadingNormal = laneOf(bounce.normal, i);
        point.query.radius = tile.context.bouncedPhotonRadius;
        point.query.mostEdges = std::min(kMostEdges, static_cast<uint32_t>(edgesLeft));
        if (use == PhotonUse::Indirect || !(block.pixel[i] & kScattered))
        {
            float& radius = gathered.radius[pixel];
            if (radius == 0.0f)
                radius = radiusOf(map, point.query, tile.context.leastPhotonRadius,
                                  tile.context.largestPhotonRadius);
            point.query.radius = radius;
        }
        PhotonSum sum;
        if ((bounce.diffuse >> i) & 1u)
            sum = gatherDiffuse(map, point.query, laneOf(bounce.albedo, i));
        else
        {
            point.bsdf = &bounce.bsdfs[i];
            point.wo = -Vec3(block.rays.ray.directionX[i], block.rays.ray.directionY[i],
                             block.rays.ray.directionZ[i]);
            sum = gatherBsdf(map, point);
        }
        if (sum.count == 0) continue;
        const Vec3 flux = laneOf(block.throughput, i) * sum.power;
        if (gathered.separate)
        {
            gathered.count[pixel] += sum.count;
            gathered.flux[pixel] += flux;
        }
        else
            tile.sums.add(pixel, flux / (kPi * point.query.radius * point.query.radius));
    }
}

} // namespace osgRayTrace::engine
