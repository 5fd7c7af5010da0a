// PathPhotons.cpp - what paths leave to photons, and get from them. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/PhotonGather.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kGatherAlpha = 0.25f; ///< GGX width from which photons replace further bounces

/// Where there are more around a point no guiding is needed to find some.
constexpr uint32_t kMostRecordedPhotons = 2048;

/// Records the photons of a lookup, to which its radiance is laid by their power: what the surface
/// makes of their directions does not matter for guiding.
void recordSeen(const PhotonMap& map, const PhotonQuery& query, float radiance,
                std::vector<SeenPhoton>& seen)
{
    std::vector<uint32_t> found;
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

/// The discs of the lanes that gather, with first radii where there are none yet.
PhotonQueryLanes queriesOf(Tile& tile, const PathBlock& block, const Bounce& bounce)
{
    const auto edgesLeft = static_cast<uint32_t>(tile.context.options.maxBounces - bounce.number);
    PhotonQueryLanes queries;
    queries.position = trianglePoints(bounce.surface);
    queries.normal = bounce.surface.geometricNormal;
    queries.shadingNormal = bounce.normal;
    queries.mostEdges = std::min(kMostEdges, edgesLeft);
    queries.lanes = bounce.gathering;
    for (const int i : lanesIn(bounce.gathering))
    {
        const PathFlags path = block.flagsOf(i);
        OSGRAYTRACE_ASSERT(!path.isReused()); // it has taken photons: chooseGathering left it out
        float& radius = tile.result.photons.gathered->radius[path.pixel()];
        if (radius == 0.0f)
            radius = radiusOf(*tile.context.photons, laneOf(queries, i),
                              tile.context.leastPhotonRadius, tile.context.largestPhotonRadius);
        queries.radius[i] = radius;
    }
    return queries;
}

/// What surfaces send back of the photons in their discs.
void gatherLanes(const PhotonMap& map, PhotonQueryLanes queries, const PathBlock& block,
                 const Bounce& bounce, PhotonSumLanes& sums)
{
    queries.lanes = bounce.gathering & bounce.diffuse;
    gatherDiffuse(map, queries, bounce.albedo, sums);
    queries.lanes = bounce.gathering & ~bounce.diffuse;
    if (!queries.lanes) return;
    GatherLanes points{queries, {}, bounce.bsdfs, bounce.gathering & ~bounce.rough};
    for (int i = 0; i < kLanes; ++i)
        setLane(points.wo, i, -directionOf(block.rays.ray, i));
    gatherBsdf(map, points, sums);
}

} // namespace

void chooseGathering(const PathBlock& block, Bounce& bounce, PhotonUse use)
{
    bounce.gathering = bounce.rough = bounce.diffuse;
    for (const int i : lanesIn(bounce.general))
    {
        const Bsdf& bsdf = bounce.bsdfs[i];
        const bool rough = bsdf.diffuse != Vec3(0.0f) || bsdf.alpha >= kGatherAlpha;
        if (rough) bounce.rough |= 1u << i;
        // In narrow lobes there are few photons: of those that paths can find further on, none is
        // needed.
        if (rough || (use == PhotonUse::Caustics && !bsdf.isSmooth())) bounce.gathering |= 1u << i;
    }
    bounce.terminating = use == PhotonUse::Indirect ? bounce.rough : 0u;
    if (use == PhotonUse::Indirect) return;
    for (const int i : lanesIn(bounce.gathering))
        if (block.flagsOf(i).hasTaken()) bounce.gathering &= ~(1u << i);
    bounce.rough &= bounce.gathering;
}

void addPhotons(Tile& tile, const PathBlock& block, const Bounce& bounce)
{
    if (!bounce.gathering) return;
    const PhotonMap& map = *tile.context.photons;
    GatheredPhotons& gathered = *tile.result.photons.gathered;
    const PhotonQueryLanes queries = queriesOf(tile, block, bounce);
    PhotonSumLanes sums;
    gatherLanes(map, queries, block, bounce, sums);
    for (const int i : lanesIn(bounce.gathering))
    {
        if (sums.count[i] == 0) continue;
        const uint32_t pixel = block.flagsOf(i).pixel();
        const Vec3 flux = laneOf(block.throughput, i) * laneOf(sums.power, i);
        const float discArea = kPi * queries.radius[i] * queries.radius[i];
        if (gathered.seenStride && (pixel + gathered.seenFirst) % gathered.seenStride == 0 &&
            sums.count[i] <= kMostRecordedPhotons)
            recordSeen(map, laneOf(queries, i), luminance(flux) / discArea, gathered.seen);
        if (gathered.separate)
        {
            gathered.count[pixel] += sums.count[i];
            gathered.flux[pixel] += flux;
        }
        else
            tile.sums.add(block.flagsOf(i), flux / discArea);
    }
}

} // namespace osgRayTrace::engine
