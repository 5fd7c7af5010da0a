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

/// Where there are more around a point no aim is needed to find some.
constexpr uint32_t kMostNotedPhotons = 2048;

/// Notes the photons of a lookup, to which its radiance is laid by their power: what the surface
/// makes of their directions does not matter for an aim.
void noteSeen(const PhotonMap& map, const PhotonQuery& query, float radiance,
              std::vector<SeenPhoton>& seen)
{
    static thread_local std::vector<uint32_t> found;
    found.clear();
    map.find(query, found);
    float power = 0.0f;
    for (const uint32_t k : found)
        power += luminance(map.photon(k).power);
    if (!(power > 0.0f)) return;
    for (const uint32_t k : found)
    {
        const Photon photon = map.photon(k);
        if (photon.bin != kInvalid)
            seen.push_back({photon.bin, radiance * luminance(photon.power) / power});
    }
}

} // namespace

void chooseGathering(const PathBlock& block, Bounce& bounce, PhotonUse use)
{
    bounce.gathering = bounce.rough = bounce.diffuse;
    for (LaneMask lanes = bounce.general; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const Bsdf& bsdf = bounce.bsdfs[i];
        const bool rough = bsdf.diffuse != Vec3(0.0f) || bsdf.alpha >= kGatherAlpha;
        if (rough) bounce.rough |= 1u << i;
        // In narrow lobes there are few photons: of those that paths can find further on, none is
        // needed.
        if (rough || (use == PhotonUse::Caustics && !bsdf.isSmooth())) bounce.gathering |= 1u << i;
    }
    bounce.ending = use == PhotonUse::Indirect ? bounce.rough : 0u;
    if (use == PhotonUse::Indirect) return;
    for (LaneMask lanes = bounce.gathering; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        if (block.pixel[i] & kTaken) bounce.gathering &= ~(1u << i);
    }
    bounce.rough &= bounce.gathering;
}

void addPhotons(Tile& tile, const PathBlock& block, const Bounce& bounce)
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
        point.query.mostEdges = std::min(kMostEdges, static_cast<uint32_t>(edgesLeft));
        float& radius = gathered.radius[pixel];
        if (radius == 0.0f)
            radius = radiusOf(map, point.query, tile.context.leastPhotonRadius,
                              tile.context.largestPhotonRadius);
        point.query.radius = radius;
        PhotonSum sum;
        if ((bounce.diffuse >> i) & 1u)
            sum = gatherDiffuse(map, point.query, laneOf(bounce.albedo, i));
        else
        {
            point.bsdf = &bounce.bsdfs[i];
            point.wo = -directionOf(block.rays.ray, i);
            point.directOnly = !((bounce.rough >> i) & 1u);
            sum = gatherBsdf(map, point);
        }
        if (sum.count == 0) continue;
        const Vec3 flux = laneOf(block.throughput, i) * sum.power;
        const float discArea = kPi * point.query.radius * point.query.radius;
        if (gathered.seenStride && (pixel + gathered.seenFirst) % gathered.seenStride == 0 &&
            sum.count <= kMostNotedPhotons)
            noteSeen(map, point.query, luminance(flux) / discArea, gathered.seen);
        if (gathered.separate)
        {
            gathered.count[pixel] += sum.count;
            gathered.flux[pixel] += flux;
        }
        else
            tile.sums.add(pixel, flux / discArea);
    }
}

} // namespace osgRayTrace::engine
