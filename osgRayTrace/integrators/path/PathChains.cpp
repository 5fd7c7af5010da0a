// PathChains.cpp - more rays from one glossy surface to another. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// Among pieces of brushed metal few rays meet a lamp's highlight on the next piece, and these make
// most of the noise. Such chains begin in a few pixels, so rays are added there alone. Let x be the
// glossy surface that the camera ray meets, X_1 the path's own ray from there, and A the rays from
// x that meet a glossy surface. The light that the path finds at that surface and later is f:
//
//   E[f 1_A] = P(A) E[f | A]
//
// 1_A(X_1) has the mean P(A). If X_1 is in A, kCompanions rays X_j of the same density follow, and
// those of them that are in A have, like X_1 itself, the density of rays in A. Their number n, X_1
// among them, does not depend on what they find, so the mean of their f is one of E[f | A]:
//
//   L_A = 1_A(X_1) * 1/n * sum over j of 1_A(X_j) f(X_j)
//
// Rays that leave A cost one intersection. The light of all other surfaces, and what the glossy one
// emits, comes from X_1 alone, as do all paths where no glossy surface is met.
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/HitShading.h"

namespace osgRayTrace::engine
{

namespace
{

constexpr int kCompanions = 4; ///< further rays of a pixel
constexpr int kPixelsOfBlock = kLanes / kCompanions;
constexpr int kFewestPixels = 4;   ///< of a tile, for companions to be worth their cost
constexpr int kFewestLeftOver = 2; ///< of a block that is not full
static_assert(kLanes % kCompanions == 0, "blocks of companions are full");

/// Tells the random numbers of companions from those of the path.
constexpr uint32_t kCompanionSeed = 0x2f6b9d31u;

/// Sets lane k of a block to companion number j of the path in lane i that met a glossy surface.
/// Returns whether the companion has a ray.
bool setCompanion(const Tile& tile, const GlossyBlock& first, int i, int j, PathBlock& block, int k)
{
    copyPath(first.path, i, block, k);
    const uint32_t seed = hash(first.path.seed[i] + kCompanionSeed, static_cast<uint32_t>(j));
    const uint32_t pass = tile.context.pathKey.index;
    float u, v, lobe, unused;
    sobol2(pass, dimensionSeed(seed, bounceDimension(0, DimensionBsdfDirection)), u, v);
    sobol2(pass, dimensionSeed(seed, bounceDimension(0, DimensionBsdfLobe)), lobe, unused);
    const ShadingFrame frame(laneOf(first.normal, i));
    const Vec3 wo = frame.toLocal(-directionOf(first.path.rays.ray, i));
    const std::optional<BsdfSample> sample = sampleBsdf(first.bsdf(i), wo, lobe, u, v);
    if (!sample || sample->delta) return false;
    const Vec3 direction = frame.toWorld(sample->wi);
    if (isAbove(first.surface, i, direction) == sample->transmitted) return false;
    const RayBegin begin = leave(first.surface, i, direction);
    setRay(block.rays.ray, k, plainOf(begin.origin), plainOf(direction), begin.tNear, kInfinity);
    const Vec3 throughput = laneOf(first.path.throughput, i) * sample->weight;
    setLane(block.throughput, k, throughput);
    block.pdfW[k] = sample->pdfW;
    block.seed[k] = seed;
    block.flags[k] = PathFlags::afterSurface(first.path.flags[i], 0u, 0u, 0u, 0u);
    return throughput != Vec3(0.0f);
}

/// Traces the companions of a few pixels, which are the block's, and adds those that go on to the
/// tile's paths.
void traceCompanions(Tile& tile, PathBlock& block, PhotonUse use)
{
    for (int i = 0; i < kLanes; ++i)
        block.rays.ray.tFar[i] = kInfinity;
    if (tile.context.traced->traits().mipmaps) moveCones(block.rays.ray, 0, block.cones);
    bounceCompanions(tile, block, use);
    const bool vertices = tile.context.traced->lights().tree() != nullptr;
    for (const int i : lanesIn(block.active))
        addPath(tile.paths, block, i, vertices);
}

/// Returns whether a general lane reflects, and all of its lobes are narrow, but not mirror-like.
bool isGlossyLane(const Bounce& bounce, int i)
{
    const LaneMask others = bounce.smooth | bounce.transmissive | bounce.subsurface;
    const Bsdf& bsdf = bounce.bsdfs[i];
    return !((others >> i) & 1u) && bsdf.alpha < kRoughAlpha && bsdf.isGlossy();
}

} // namespace

LaneMask glossyLanes(const Bounce& bounce)
{
    LaneMask lanes = 0;
    for (const int i : lanesIn(bounce.general))
        lanes |= static_cast<LaneMask>(isGlossyLane(bounce, i)) << i;
    return lanes;
}

void beginChains(Tile& tile, PhotonUse use)
{
    const SceneTraits& traits = tile.context.traced->traits();
    tile.chains.active =
        traits.glossy && use == PhotonUse::None && !traits.media && !traits.fog && !traits.ground;
}

void recordGlossy(Tile& tile, int b, const Bounce& bounce)
{
    const PathBlock& block = tile.paths.blocks[b];
    const LaneMask lanes = glossyLanes(bounce) & block.active;
    if (!lanes) return;
    tile.chains.first[b] = std::make_unique<GlossyBlock>();
    GlossyBlock& first = *tile.chains.first[b];
    first.lanes = lanes;
    first.surface = bounce.surface;
    first.normal = bounce.normal;
    first.path = block;
    first.bsdfs.reserve(static_cast<std::size_t>(countLanes(lanes)));
    for (const int i : lanesIn(lanes))
        first.bsdfs.push_back(bounce.bsdfs[i]);
}

void countChains(Tile& tile, PathBlock& block, const Bounce& bounce)
{
    GlossyChains& chains = tile.chains;
    for (const int i : lanesIn(bounce.general & block.active))
    {
        const uint32_t pixel = block.flagsOf(i).pixel(), b = pixel / kLanes, lane = pixel % kLanes;
        if (!chains.first[b] || !chains.first[b]->has(lane)) continue;
        if (!isGlossyLane(bounce, i)) continue;
        ++chains.rays[pixel];
        chains.met[b] |= 1u << lane;
        block.flags[i] = block.flagsOf(i).reused().word();
    }
}

void addCompanions(Tile& tile, PhotonUse use)
{
    // Which pixels have companions depends on first rays and other pixels alone, not on what the
    // companions find.
    int met = 0;
    for (const LaneMask lanes : tile.chains.met)
        met += countLanes(lanes);
    if (met < kFewestPixels) return;
    PathBlock block;
    clearRays(block.rays.ray);
    int pixels = 0;
    block.active = 0;
    for (int b = 0; b < kTileBlocks; ++b)
        for (const int i : lanesIn(tile.chains.met[b]))
        {
            if (pixels == 0 && tile.paths.room() < kLanes) return;
            for (int j = 0; j < kCompanions; ++j)
            {
                const int k = pixels * kCompanions + j;
                const bool leaves = setCompanion(tile, *tile.chains.first[b], i, j, block, k);
                block.active |= static_cast<LaneMask>(leaves) << k;
            }
            if (++pixels < kPixelsOfBlock) continue;
            traceCompanions(tile, block, use);
            pixels = 0;
            block.active = 0;
        }
    if (pixels < kFewestLeftOver || tile.paths.room() < kLanes) return;
    for (int k = pixels * kCompanions; k < kLanes; ++k)
        copyPath(block, 0, block, k);
    traceCompanions(tile, block, use);
}

void addChains(Tile& tile)
{
    for (int b = 0; b < kTileBlocks; ++b)
        for (const int i : lanesIn(tile.chains.met[b]))
        {
            const auto pixel = static_cast<uint32_t>(b * kLanes + i);
            const PathFlags path = PathFlags::ofPixel(pixel);
            const float scale = 1.0f / static_cast<float>(tile.chains.rays[pixel]);
            tile.sums.add(path, tile.sums.reused(path) * scale);
        }
}

} // namespace osgRayTrace::engine
