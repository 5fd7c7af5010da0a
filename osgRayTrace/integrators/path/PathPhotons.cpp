// PathPhotons.cpp - chooses the surfaces that look up photons, and adds them. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/PhotonGather.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kSmallerDisc = 0.5f; ///< radius of the disc that a disc is compared with, over its
                                     ///< own

/// Look-ups with more photons than this are not recorded: no guiding is needed to find photons
/// there.
constexpr uint32_t kMostRecordedPhotons = 2048;

/// Records the photons of a look-up and the share of its radiance that each photon added. The
/// shares go by power alone, as the BSDF's values for the photons' directions do not matter for
/// guiding.
void recordSeen(const PhotonMap& map, const PhotonQuery& query, float radiance,
                std::vector<uint32_t>& found, std::vector<SeenPhoton>& seen)
{
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

/// Records where some of the pixels look up photons.
void recordPoints(const PathBlock& block, const PhotonQueryLanes& queries,
                  GatheredPhotons& gathered)
{
    if (!gathered.pointStride) return;
    for (const int i : lanesIn(queries.lanes))
        if (block.flagsOf(i).pixel() % gathered.pointStride == 0)
            gathered.points.push_back({laneOf(queries.position, i), laneOf(queries.normal, i)});
}

/// Records light of first hits that a footprint may take the place of.
void recordFirstHit(GatheredPhotons& gathered, uint32_t pixel, Vec3 radiance)
{
    if (gathered.wantsFirstHits && isFinite(radiance)) gathered.atFirstHits[pixel] += radiance;
}

/// Returns the discs of the lanes that gather, but for those that take the photons of footprints,
/// and chooses the first radius of each pixel that has none yet.
PhotonQueryLanes queriesOf(Tile& tile, const PathBlock& block, const Bounce& bounce,
                           FootprintSums& footprints)
{
    const auto edgesLeft = static_cast<uint32_t>(tile.context.options.maxBounces - bounce.number);
    PhotonQueryLanes queries;
    queries.position = trianglePoints(bounce.surface);
    queries.normal = bounce.surface.geometricNormal;
    queries.shadingNormal = bounce.normal;
    queries.mostEdges = std::min(kMostEdges, edgesLeft);
    queries.lanes = bounce.gathering;
    recordPoints(block, queries, *tile.result.photons.gathered);
    gatherFootprints(tile, block, bounce, queries, footprints);
    queries.lanes &= ~footprints.chosen;
    for (const int i : lanesIn(queries.lanes))
    {
        const PathFlags path = block.flagsOf(i);
        // A reused path has taken photons, so chooseGathering left such a path out.
        OSGRAYTRACE_ASSERT(!path.isReused());
        float& radius = tile.result.photons.gathered->radius[path.pixel()];
        if (radius == 0.0f)
            radius =
                radiusOf(*tile.context.photons, laneOf(queries, i), tile.context.leastPhotonRadius,
                         tile.context.largestPhotonRadius, tile.gatherScratch);
        queries.radius[i] = radius;
    }
    return queries;
}

/// Sets sums to f times power, summed over the photons in the discs of the queries' lanes.
void gatherLanes(Tile& tile, const PhotonQueryLanes& queries, const PathBlock& block,
                 const Bounce& bounce, PhotonSumLanes& sums)
{
    const PhotonMap& map = *tile.context.photons;
    const LaneMask general = queries.lanes & ~bounce.diffuse;
    if (!general) return gatherDiffuse(map, queries, bounce.albedo, sums);
    GatherLanes points{queries, {}, bounce.bsdfs, bounce.gathering & ~bounce.rough};
    points.queries.lanes = queries.lanes & bounce.diffuse;
    gatherDiffuse(map, points.queries, bounce.albedo, sums);
    points.queries.lanes = general;
    for (int i = 0; i < kLanes; ++i)
        setLane(points.wo, i, -directionOf(block.rays.ray, i));
    gatherBsdf(map, points, sums, tile.gatherScratch);
}

/// Sets the radiance that the photons of discs become on their way to the eye: 0 in lanes without
/// any.
OSGRAYTRACE_KERNEL
void radianceOf(const Vec3Lanes& throughput, const PhotonQueryLanes& queries,
                const PhotonSumLanes& sums, Vec3Lanes& radiance)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const uint32_t in = laneBit(queries.lanes, i) & maskOf(sums.count[i] != 0);
        const float perArea = 1.0f / (kPi * queries.radius[i] * queries.radius[i]);
        radiance.x[i] = select(in, throughput.x[i] * sums.power.x[i] * perArea, 0.0f);
        radiance.y[i] = select(in, throughput.y[i] * sums.power.y[i] * perArea, 0.0f);
        radiance.z[i] = select(in, throughput.z[i] * sums.power.z[i] * perArea, 0.0f);
    }
}

/// Returns those of the lanes whose pixels are in the block that compares discs, without those that
/// correctEdges corrects: at an edge discs of all radii have shares of their own.
LaneMask comparedLanes(const GatheredPhotons& gathered, const PathBlock& block, LaneMask gathering)
{
    LaneMask lanes = 0;
    for (const int i : lanesIn(gathering))
    {
        const uint32_t pixel = block.flagsOf(i).pixel();
        const bool near = gathered.planes && gathered.planes[pixel].edge > DiscEdge::None;
        if (static_cast<int>(pixel) / kLanes == gathered.comparedBlock && !near) lanes |= 1u << i;
    }
    return lanes;
}

/// Adds the differences between each disc's radiance and that by the next smaller disc, whose
/// photons are among those of the larger one. sums are those of the discs of the queries.
void compareDiscs(Tile& tile, const PhotonQueryLanes& discs, const PathBlock& block,
                  const Bounce& bounce, const PhotonSumLanes& discSums)
{
    GatheredPhotons& gathered = *tile.result.photons.gathered;
    const LaneMask compared = comparedLanes(gathered, block, discs.lanes);
    if (!compared) return;
    PhotonQueryLanes queries = discs;
    queries.lanes = compared;
    PhotonSumLanes sums = discSums, smaller;
    for (auto& differences : gathered.differences)
    {
        PhotonQueryLanes half = queries;
        for (const int i : lanesIn(queries.lanes))
            half.radius[i] = queries.radius[i] * kSmallerDisc;
        gatherLanes(tile, half, block, bounce, smaller);
        for (const int i : lanesIn(queries.lanes))
        {
            const float discArea = kPi * queries.radius[i] * queries.radius[i];
            const Vec3 difference =
                laneOf(block.throughput, i) *
                (laneOf(sums.power, i) - laneOf(smaller.power, i) / (kSmallerDisc * kSmallerDisc)) /
                discArea;
            if (isFinite(difference)) differences[block.flagsOf(i).pixel() % kLanes] += difference;
        }
        queries = half;
        sums = smaller;
    }
}

/// Returns the lanes whose discs no footprint is compared with.
LaneMask blurredLanes(const Tile& tile, const PathBlock& block, const Bounce& bounce,
                      LaneMask lanes)
{
    const GatheredPhotons& gathered = *tile.result.photons.gathered;
    if (!gathered.wantsBlur || !gathered.planes) return 0;
    if (bounce.number > 0 || bounce.below) return lanes;
    LaneMask result = lanes & bounce.collided;
    if (tile.context.photonUse != PhotonUse::Caustics) return result;
    for (const int i : lanesIn(lanes))
        if (gathered.planes[block.flagsOf(i).pixel()].lookup == PixelLookup::Disc)
            result |= 1u << i;
    return result;
}

/// Sums up the light of discs, and the part of it that is blur. Means of the light over discs are
/// off by a multiple of the square of the radius, so two of them tell that: L(r) - L(r / 2) is
/// three quarters of it [Richardson11].
void measureBlur(Tile& tile, const PhotonQueryLanes& queries, const PathBlock& block,
                 const Bounce& bounce, const PhotonSumLanes& sums)
{
    const LaneMask lanes = blurredLanes(tile, block, bounce, queries.lanes);
    if (!lanes) return;
    if (!tile.blurred) tile.blurred = std::make_unique<BlurredLight>();
    GatheredPhotons& gathered = *tile.result.photons.gathered;
    PhotonQueryLanes half = queries;
    half.lanes = lanes;
    for (const int i : lanesIn(lanes))
        half.radius[i] = queries.radius[i] * kSmallerDisc;
    PhotonSumLanes smaller;
    gatherLanes(tile, half, block, bounce, smaller);
    constexpr float kArea = kSmallerDisc * kSmallerDisc;
    for (const int i : lanesIn(lanes))
    {
        const float discArea = kPi * queries.radius[i] * queries.radius[i];
        const Vec3 scale = laneOf(block.throughput, i) / discArea;
        const Vec3 light = scale * laneOf(sums.power, i);
        const Vec3 blur =
            (light - scale * laneOf(smaller.power, i) / kArea) * (1.0f / (1.0f - kArea));
        if (!isFinite(light) || !isFinite(blur)) continue;
        tile.blurred->pixels[block.flagsOf(i).pixel()] += light;
        gathered.blurred += light;
        gathered.blur += blur;
    }
}

} // namespace

void takeBlur(Tile& tile)
{
    if (!tile.blurred || !tile.result.photons.gathered->takesBlur) return;
    const GatheredPhotons& gathered = *tile.result.photons.gathered;
    Vec3 share = gathered.earlierBlur;
    for (int c = 0; c < 3; ++c)
        if (gathered.blurred[c] > 0.0f) share[c] += gathered.blur[c] / gathered.blurred[c];
    for (uint32_t p = 0; p < kTilePixels; ++p)
        tile.sums.add(PathFlags::ofPixel(p), -share * tile.blurred->pixels[p]);
}

void chooseGathering(const PathBlock& block, Bounce& bounce, PhotonUse use)
{
    bounce.gathering = bounce.rough = bounce.diffuse;
    for (const int i : lanesIn(bounce.general))
    {
        const Bsdf& bsdf = bounce.bsdfs[i];
        const bool spreads = bsdf.diffuse + bsdf.diffuseTransmission != Vec3(0.0f);
        const bool rough = spreads || bsdf.alpha >= kRoughAlpha;
        if (rough) bounce.rough |= 1u << i;
        // Narrow lobes hold few photons. Paths go on in narrow lobes, and look up only caustics,
        // which paths cannot find.
        if (rough || (use == PhotonUse::Caustics && !bsdf.isSmooth())) bounce.gathering |= 1u << i;
    }
    bounce.terminating = use == PhotonUse::Indirect ? bounce.rough : 0u;
    if (use == PhotonUse::Indirect) return;
    // Paths and photons agree which points are glossy: a path that has taken photons was scattered,
    // and reads textures without a cone, as photons do.
    for (const int i : lanesIn(bounce.diffuse | bounce.general))
    {
        if (!block.flagsOf(i).hasTaken()) continue;
        bounce.gathering &= ~(1u << i);
        const bool glossy = (bounce.general >> i & 1u) && bounce.bsdfs[i].isGlossy();
        bounce.carried |= static_cast<LaneMask>(glossy) << i;
    }
    bounce.rough &= bounce.gathering;
}

void addPhotons(Tile& tile, const PathBlock& block, const Bounce& bounce)
{
    if (!bounce.gathering) return;
    GatheredPhotons& gathered = *tile.result.photons.gathered;
    FootprintSums footprints;
    const PhotonQueryLanes queries = queriesOf(tile, block, bounce, footprints);
    for (const int i : lanesIn(footprints.chosen))
    {
        tile.sums.add(block.flagsOf(i), laneOf(footprints.radiance, i));
        recordFirstHit(gathered, block.flagsOf(i).pixel(), laneOf(footprints.radiance, i));
        gathered.carried += luminance(laneOf(footprints.radiance, i));
    }
    if (!queries.lanes) return;
    PhotonSumLanes sums;
    gatherLanes(tile, queries, block, bounce, sums);
    if (gathered.comparedBlock >= 0) compareDiscs(tile, queries, block, bounce, sums);
    measureBlur(tile, queries, block, bounce, sums);
    correctEdges(tile, block, bounce, queries, sums);
    Vec3Lanes radiance;
    const LaneMask firstHits = bounce.number > 0 || bounce.below ? 0 : ~bounce.collided;
    radianceOf(block.throughput, queries, sums, radiance);
    for (const int i : lanesIn(queries.lanes))
    {
        if (sums.count[i] == 0) continue;
        const uint32_t pixel = block.flagsOf(i).pixel();
        const Vec3 light = laneOf(radiance, i);
        gathered.carried += luminance(light);
        if (gathered.seenStride && (pixel + gathered.seenFirst) % gathered.seenStride == 0 &&
            sums.count[i] <= kMostRecordedPhotons)
            recordSeen(*tile.context.photons, laneOf(queries, i), luminance(light),
                       tile.gatherScratch.found, gathered.seen);
        if (gathered.separate)
        {
            gathered.count[pixel] += sums.count[i];
            gathered.flux[pixel] += laneOf(block.throughput, i) * laneOf(sums.power, i);
        }
        else
        {
            tile.sums.add(block.flagsOf(i), light);
            if ((firstHits >> i) & 1u) recordFirstHit(gathered, pixel, light);
        }
    }
    chooseFootprints(tile, block, bounce, queries, radiance, footprints);
    if (!gathered.balances) return;
    for (const int i : lanesIn(footprints.compared))
    {
        const Vec3 difference = laneOf(radiance, i) - laneOf(footprints.radiance, i);
        if (isFinite(difference)) gathered.leaked += difference;
    }
}

} // namespace osgRayTrace::engine
