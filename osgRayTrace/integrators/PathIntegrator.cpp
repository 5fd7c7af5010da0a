// PathIntegrator.cpp - unidirectional path tracing, the reference for everything else. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// Estimator of the radiance along a camera ray [Kajiya86; Veach97, ch. 8 and 9]:
//
//   L = sum over bounces k of beta_k * ( w_bsdf Le(x_k) + w_light f cos Le(y) V / (pmf pdfW)
//                                        + sum over delta lights of f cos pi I V )
//   beta_{k+1} = beta_k f cos / pdfW / q
//
// with the power heuristic w = p_a^2 / (p_a^2 + p_b^2), y sampled on one area light chosen by power, and
// q the survival probability of Russian roulette: beta as it would be outside of all glass, at most 1. A
// smaller cap would let beta grow past 1 along paths that lose less than it does, and their variance with it;
// beta in glass is 1/eta^2 of what comes out again. Sixteen paths are followed together; those that end are
// replaced by closing the ranks of the tile after each bounce.
#include "osgRayTrace/integrators/PathIntegrator.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/CameraLanes.h"
#include "osgRayTrace/integrators/HitShading.h"
#include "osgRayTrace/integrators/PathQueue.h"
#include "osgRayTrace/integrators/PhotonGather.h"
#include "osgRayTrace/integrators/ShadowLanes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kRouletteBounce = 3;      ///< paths are not ended by chance before this bounce
constexpr float kGatherAlpha = 0.25f;   ///< GGX width from which photons replace further bounces

OSGRAYTRACE_INLINE float powerHeuristic(float a, float b)
{
    const float ratio = b / a; // no overflow of a^2, and 1 for a = infinity
    return 1.0f / (1.0f + ratio * ratio);
}

/// Sums of the tile, pixel by pixel.
struct PixelSums
{
    float r[kTilePixels] = {};
    float g[kTilePixels] = {};
    float b[kTilePixels] = {};
    float a[kTilePixels] = {};

    void add(uint32_t pixelBits, Vec3 radiance)
    {
        const uint32_t pixel = pixelBits & kPixelBits;
        r[pixel] += radiance.x;
        g[pixel] += radiance.y;
        b[pixel] += radiance.z;
    }
};

struct Tile
{
    Tile(const PassContext& c, int l, int b, TileResult& r)
        : context(c), result(r), counts(r.counts), diagnostics(r.diagnostics), left(l), bottom(b)
    {
    }

    const PassContext& context;
    TileResult& result;
    TileCounts& counts;
    TileDiagnostics* diagnostics;
    int left, bottom;
    PixelSums sums;
    PathQueue paths;
    Bsdf bsdfs[kLanes]; ///< of the block at work
};

void countRays(Tile& tile, const PathBlock& block, LaneMask lanes)
{
    if (!tile.diagnostics) return;
    for (; lanes; lanes &= lanes - 1)
        tile.diagnostics->rays[block.pixel[__builtin_ctz(lanes)] & kPixelBits] += 1.0f;
}

/// Emission that the path met by chance, weighted against light samples.
template <PhotonUse use>
void addEmission(Tile& tile, const PathBlock& block, const SurfaceLanes& surface)
{
    const TracedScene& traced = *tile.context.traced;
    for (LaneMask lanes = surface.hits; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        if (!traced.materials()[surface.material[i]].emits) continue;
        const Vec3 emission = emissionTowardsRay(tile.context, block.rays, surface, i);
        if (emission == Vec3(0.0f)) continue;
        float weight = 1.0f;
        const uint32_t light = traced.surfaces()[surface.instance[i]].light;
        if (light != kInvalid && traced.lights().areaLightPmf(light) > 0.0f)
        {
            if (use == PhotonUse::Caustics && (block.pixel[i] & kCausticChain)) continue; // of photons
            const Vec3 direction(block.rays.ray.directionX[i], block.rays.ray.directionY[i],
                                 block.rays.ray.directionZ[i]);
            const float cosThetaL = std::fabs(glm::dot(direction, laneOf(surface.geometricNormal, i)));
            const float pdfLight = traced.lights().areaLightPmf(light) *
                                   traced.lights().pdfArea(light, block.rays.ray.tFar[i], cosThetaL);
            weight = powerHeuristic(block.pdfW[i], pdfLight);
        }
        tile.sums.add(block.pixel[i], laneOf(block.throughput, i) * emission * weight);
    }
}

/// A light sample for each lane of a diffuse block: vector code.
OSGRAYTRACE_KERNEL
void diffuseLight(const Vec3Lanes& normal, const Vec3Lanes& albedo, const LightLanes& light,
                  LaneMask visible, const Vec3Lanes& throughput, bool alone, Vec3Lanes& radiance)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float cosine = normal.x[i] * light.wi.x[i] + normal.y[i] * light.wi.y[i] +
                             normal.z[i] * light.wi.z[i];
        const float positive = cosine > 0.0f ? cosine : 0.0f;
        const float pdfBsdf = positive * kInvPi;
        const float ratio = pdfBsdf * light.weight[i];
        const float mis = select(alone, 1.0f, 1.0f / (1.0f + ratio * ratio));
        const float unmasked = pdfBsdf * light.weight[i] * mis;
        const float weight = select(laneBit(visible, i), unmasked, 0.0f);
        radiance.x[i] = throughput.x[i] * albedo.x[i] * light.radiance[0][i] * weight;
        radiance.y[i] = throughput.y[i] * albedo.y[i] * light.radiance[1][i] * weight;
        radiance.z[i] = throughput.z[i] * albedo.z[i] * light.radiance[2][i] * weight;
    }
}

OSGRAYTRACE_KERNEL
void dimensionPoints(const UintLanes& seeds, uint32_t passIndex, uint32_t dimension, FloatLanes& u,
                     FloatLanes& v)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        float x, y;
        sobol2(passIndex, dimensionSeed(seeds[i], dimension), x, y);
        u[i] = x;
        v[i] = y;
    }
}

/// What one bounce of a block knows.
struct Bounce
{
    int number = 0;
    SurfaceLanes surface;
    Vec3Lanes normal;       ///< shading, on the side of the ray
    Vec3Lanes albedo;       ///< of diffuse lanes
    LaneMask diffuse = 0;   ///< plain Lambert lanes
    LaneMask general = 0;   ///< all other hits that scatter
    LaneMask through = 0;   ///< general lanes that transmit
    LaneMask gathering = 0; ///< lanes that look up photons
    LaneMask ending = 0;    ///< of these, those that go on by mirror-like lobes only
    Bsdf* bsdfs = nullptr;  ///< of general lanes
};

/// Adds what the visible lanes get from one light sample. Lanes of alone have no other chance to meet this
/// light: it has its full weight.
void addLight(Tile& tile, const PathBlock& block, const Bounce& bounce, const LightLanes& light,
              LaneMask visible, LaneMask alone)
{
    if (visible & bounce.diffuse)
    {
        Vec3Lanes radiance;
        diffuseLight(bounce.normal, bounce.albedo, light, visible & bounce.diffuse,
                     block.throughput, (visible & bounce.diffuse & alone) != 0, radiance);
        for (LaneMask lanes = visible & bounce.diffuse; lanes; lanes &= lanes - 1)
        {
            const int i = __builtin_ctz(lanes);
            tile.sums.add(block.pixel[i], laneOf(radiance, i));
        }
    }
    for (LaneMask lanes = visible & bounce.general; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const ShadingFrame frame(laneOf(bounce.normal, i));
        const Vec3 wo = frame.toLocal(-Vec3(block.rays.ray.directionX[i], block.rays.ray.directionY[i],
                                            block.rays.ray.directionZ[i]));
        const Vec3 wiWorld = laneOf(light.wi, i);
        const Vec3 wi = frame.toLocal(wiWorld);
        // Light and shading normal must agree on the side, or light leaks through smooth surfaces.
        if ((wi.z > 0.0f) != isAbove(bounce.surface, i, wiWorld)) continue;
        const BsdfValue value = evalBsdf(bounce.bsdfs[i], wo, wi);
        if (!(value.pdfW > 0.0f)) continue;
        const float mis =
            (alone >> i) & 1u ? 1.0f : powerHeuristic(1.0f, value.pdfW * light.weight[i]);
        const Vec3 radiance(light.radiance[0][i], light.radiance[1][i], light.radiance[2][i]);
        tile.sums.add(block.pixel[i],
                      laneOf(block.throughput, i) * value.fCos * radiance * (light.weight[i] * mis));
    }
}

void sampleOneLight(Tile& tile, PathBlock& block, const Bounce& bounce, uint32_t light, float pmf,
                    LaneMask lanes, const FloatLanes& u, const FloatLanes& v)
{
    LightLanes samples;
    areaLightLanes(tile.context, light, pmf, bounce.surface, lanes, bounce.through, u, v, samples);
    countRays(tile, block, samples.lit);
    const LaneMask visible = visibleLanes(tile.context, samples, tile.counts);
    addLight(tile, block, bounce, samples, visible, bounce.ending);
}

/// Light samples change from pass to pass also where the camera path does not.
UintLanes lightSeeds(const PassContext& context, const PathBlock& block)
{
    UintLanes seeds;
    for (int i = 0; i < kLanes; ++i)
        seeds[i] = block.seed[i] ^ context.key.seed ^ context.pathKey.seed;
    return seeds;
}

void sampleLights(Tile& tile, PathBlock& block, const Bounce& bounce)
{
    const LightTable& table = tile.context.traced->lights();
    const LaneMask lanes = bounce.diffuse | bounce.general;
    for (const uint32_t light : table.deltaLights())
    {
        LightLanes samples;
        deltaLightLanes(tile.context, light, bounce.surface, lanes, bounce.through, samples);
        countRays(tile, block, samples.lit);
        addLight(tile, block, bounce, samples, visibleLanes(tile.context, samples, tile.counts), kAllLanes);
    }
    if (table.areaLights().empty()) return;

    FloatLanes u, v;
    const UintLanes seeds = lightSeeds(tile.context, block);
    dimensionPoints(seeds, tile.context.key.index, bounceDimension(bounce.number, DimensionLightPoint), u, v);
    if (table.areaLights().size() == 1)
    {
        sampleOneLight(tile, block, bounce, table.areaLights()[0], 1.0f, lanes, u, v);
        return;
    }
    // Lanes that chose the same light are sampled together.
    FloatLanes choice, unused;
    dimensionPoints(seeds, tile.context.key.index, bounceDimension(bounce.number, DimensionLightChoice),
                    choice, unused);
    LaneMask open = lanes;
    LightTable::Choice chosen[kLanes];
    for (LaneMask m = lanes; m; m &= m - 1)
        chosen[__builtin_ctz(m)] = table.chooseAreaLight(choice[__builtin_ctz(m)]);
    while (open)
    {
        const LightTable::Choice& first = chosen[__builtin_ctz(open)];
        LaneMask same = 0;
        for (LaneMask m = open; m; m &= m - 1)
            same |= static_cast<LaneMask>(chosen[__builtin_ctz(m)].light == first.light)
                    << __builtin_ctz(m);
        sampleOneLight(tile, block, bounce, first.light, first.pmf, same, u, v);
        open &= ~same;
    }
}

/// Next directions of diffuse lanes: vector code. Weight is the albedo, pdfW = cos/pi. Returns the lanes whose
/// direction is one that light comes from: see isAbove.
OSGRAYTRACE_KERNEL
LaneMask diffuseDirections(const Vec3Lanes& normal, const SurfaceLanes& surface, const FloatLanes& u,
                       const FloatLanes& v, Vec3Lanes& wi, Vec3Lanes& origin, FloatLanes& pdfW)
{
    const LaneMask lifted = surface.lifted;
    LaneMask alive = 0;
    OSGRAYTRACE_SIMD_OR(alive)
    for (int i = 0; i < kLanes; ++i)
    {
        const float nx = normal.x[i], ny = normal.y[i], nz = normal.z[i];
        float sine, cosine;
        sinCosTurn(u[i], sine, cosine);
        const float radius = std::sqrt(v[i]);
        const float lx = radius * cosine, ly = radius * sine;
        const float lz = std::sqrt(1.0f - v[i]);
        const float sign = nz >= 0.0f ? 1.0f : -1.0f;
        const float a = -1.0f / (sign + nz);
        const float b = nx * ny * a;
        const float wx = (1.0f + sign * nx * nx * a) * lx + b * ly + nx * lz;
        const float wy = sign * b * lx + (sign + ny * ny * a) * ly + ny * lz;
        const float wz = -sign * nx * lx - ny * ly + nz * lz;
        const float gx = surface.geometricNormal.x[i], gy = surface.geometricNormal.y[i],
                    gz = surface.geometricNormal.z[i];
        wi.x[i] = wx;
        wi.y[i] = wy;
        wi.z[i] = wz;
        pdfW[i] = lz * kInvPi;
        origin.x[i] = surface.position.x[i] + gx * surface.offset[i];
        origin.y[i] = surface.position.y[i] + gy * surface.offset[i];
        origin.z[i] = surface.position.z[i] + gz * surface.offset[i];
        const uint32_t above = maskOf(wx * gx + wy * gy + wz * gz > 0.0f) | laneBit(lifted, i);
        alive |= bitOfLane(above & maskOf(lz > 0.0f), i);
    }
    return alive;
}

/// Sets the ray of each lane that goes on; the others leave block.active.
void scatter(Tile& tile, PathBlock& block, const Bounce& bounce)
{
    FloatLanes u, v, lobe, roulette;
    const uint32_t pass = tile.context.pathKey.index;
    dimensionPoints(block.seed, pass, bounceDimension(bounce.number, DimensionBsdfDirection), u, v);
    dimensionPoints(block.seed, pass, bounceDimension(bounce.number, DimensionBsdfLobe), lobe, roulette);

    Vec3Lanes wi, origin;
    FloatLanes pdfW;
    Vec3Lanes weight = bounce.albedo;
    LaneMask alive = 0;
    if (const LaneMask diffuse = bounce.diffuse & ~bounce.ending)
        alive = diffuseDirections(bounce.normal, bounce.surface, u, v, wi, origin, pdfW) & diffuse;
    for (LaneMask lanes = bounce.general; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const ShadingFrame frame(laneOf(bounce.normal, i));
        const Vec3 wo = frame.toLocal(-Vec3(block.rays.ray.directionX[i], block.rays.ray.directionY[i],
                                            block.rays.ray.directionZ[i]));
        const std::optional<BsdfSample> sample = sampleBsdf(bounce.bsdfs[i], wo, lobe[i], u[i], v[i]);
        if (!sample || (!sample->delta && ((bounce.ending >> i) & 1u))) continue;
        const Vec3 direction = frame.toWorld(sample->wi);
        if (isAbove(bounce.surface, i, direction) == sample->transmitted) continue;
        setLane(wi, i, direction);
        setLane(origin, i, leave(bounce.surface, i, direction));
        setLane(weight, i, sample->weight);
        pdfW[i] = sample->delta ? kInfinity : sample->pdfW;
        if (sample->transmitted) block.etaScale[i] *= bounce.bsdfs[i].eta * bounce.bsdfs[i].eta;
        alive |= 1u << i;
    }

    LaneMask survivors = 0;
    for (LaneMask lanes = alive; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        Vec3 throughput = laneOf(block.throughput, i) * laneOf(weight, i);
        const float largest = std::max(throughput.x, std::max(throughput.y, throughput.z));
        if (!(largest > 0.0f)) continue;
        const float survival = largest * block.etaScale[i];
        if (bounce.number + 1 >= kRouletteBounce && survival < 1.0f)
        {
            if (roulette[i] >= survival) continue;
            throughput /= survival;
        }
        setLane(block.throughput, i, throughput);
        RayBlock& ray = block.rays.ray;
        ray.originX[i] = origin.x[i];
        ray.originY[i] = origin.y[i];
        ray.originZ[i] = origin.z[i];
        ray.directionX[i] = wi.x[i];
        ray.directionY[i] = wi.y[i];
        ray.directionZ[i] = wi.z[i];
        ray.tNear[i] = 0.0f;
        ray.tFar[i] = kInfinity;
        block.pdfW[i] = pdfW[i];
        if (pdfW[i] < kInfinity)
        {
            block.pixel[i] = (block.pixel[i] | kScattered) & ~(kCausticChain | kGathered);
            if ((bounce.gathering >> i) & 1u) block.pixel[i] |= kGathered;
        }
        else if (block.pixel[i] & kGathered)
            block.pixel[i] |= kCausticChain;
        survivors |= 1u << i;
    }
    block.active = survivors;
}

void classify(const Tile& tile, const PathBlock& block, Bounce& bounce)
{
    facingNormalLanes(block.rays.ray, bounce.surface, bounce.normal);
    const MaterialTable& materials = tile.context.traced->materials();
    bounce.diffuse = bounce.general = bounce.through = 0;
    for (LaneMask lanes = bounce.surface.hits; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const MaterialRecord& record = materials[bounce.surface.material[i]];
        if (record.plainDiffuse)
        {
            setLane(bounce.albedo, i, record.front.diffuse);
            const bool black = record.front.diffuse == Vec3(0.0f);
            bounce.diffuse |= static_cast<LaneMask>(!black) << i;
            continue;
        }
        const bool front = (bounce.surface.front >> i) & 1u;
        bounce.bsdfs[i] = record.constant ? (front ? record.front : record.back)
                                          : materials.bsdf(bounce.surface.material[i],
                                                           materialPoint(tile.context, block.rays,
                                                                         bounce.surface, i));
        if (bounce.bsdfs[i].isDiffuse() && bounce.bsdfs[i].diffuse == Vec3(0.0f)) continue;
        bounce.general |= 1u << i;
        bounce.through |= static_cast<LaneMask>(bounce.bsdfs[i].transmits()) << i;
    }
    dropLift(bounce.surface, bounce.through); // refraction depends on where the facet is
}

/// Which lanes look up photons, and which of them end here but for their mirror-like lobes.
template <PhotonUse use> void chooseGathering(Bounce& bounce)
{
    bounce.gathering = bounce.diffuse;
    bounce.ending = use == PhotonUse::Indirect ? bounce.diffuse : 0u;
    for (LaneMask lanes = bounce.general; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const Bsdf& bsdf = bounce.bsdfs[i];
        const bool lambert = bsdf.diffuse != Vec3(0.0f);
        if (bsdf.transmits()) continue;
        const bool rough = lambert || bsdf.alpha >= kGatherAlpha;
        const bool scatters = lambert || !bsdf.isSmooth();
        if (use == PhotonUse::Indirect ? rough : scatters) bounce.gathering |= 1u << i;
        if (use == PhotonUse::Indirect && rough) bounce.ending |= 1u << i;
    }
}

/// Adds what the photons around the lanes' points send back along their rays. The radius belongs to the
/// pixel where light that the photons carry is seen directly; after a bounce it is the same for all.
template <PhotonUse use> void addPhotons(Tile& tile, const PathBlock& block, const Bounce& bounce)
{
    const PhotonMap& map = *tile.context.photons;
    GatheredPhotons& gathered = *tile.result.gathered;
    for (LaneMask lanes = bounce.gathering; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const uint32_t pixel = block.pixel[i] & kPixelBits;
        GatherPoint point;
        point.query.position = laneOf(trianglePoints(bounce.surface), i);
        point.query.normal = laneOf(bounce.surface.geometricNormal, i);
        point.query.shadingNormal = laneOf(bounce.normal, i);
        point.query.radius = tile.context.bouncedPhotonRadius;
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

/// Follows the paths of a block over one bounce.
template <PhotonUse use> void bounceBlock(Tile& tile, int b, int number, bool last)
{
    PathBlock& block = tile.paths.blocks[b];
    const TracedScene& traced = *tile.context.traced;
    const Coherence coherence = number == 0 ? Coherence::Coherent : Coherence::Incoherent;
    traced.intersector().closestHits(block.rays, block.active, coherence);
    const auto rays = static_cast<uint64_t>(__builtin_popcount(block.active));
    (number == 0 ? tile.counts.cameraRays : tile.counts.secondaryRays) += rays;
    countRays(tile, block, block.active);

    Bounce bounce;
    bounce.number = number;
    bounce.bsdfs = tile.bsdfs;
    surfacesOf(traced.surfaces(), block.rays, block.active, bounce.surface,
               rayStart(tile.context.options));
    const Vec3 background(traced.scene().background);
    for (LaneMask lanes = block.active & ~bounce.surface.hits; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        if (number > 0 && !(block.pixel[i] & kScattered))
            tile.sums.add(block.pixel[i], laneOf(block.throughput, i) * background);
    }
    addEmission<use>(tile, block, bounce.surface);
    if (number == 0)
    {
        if (tile.context.wantsDepth)
            depthLanes(tile.context.camera, tile.left, tile.bottom, b, bounce.surface,
                       tile.result.depth + b * kLanes);
        for (LaneMask lanes = bounce.surface.hits; lanes; lanes &= lanes - 1)
            tile.sums.a[block.pixel[__builtin_ctz(lanes)] & kPixelBits] = 1.0f;
    }
    if (last)
    {
        block.active = 0;
        return;
    }
    classify(tile, block, bounce);
    if (!(bounce.diffuse | bounce.general))
    {
        block.active = 0;
        return;
    }
    if constexpr (use != PhotonUse::None)
    {
        chooseGathering<use>(bounce);
        addPhotons<use>(tile, block, bounce);
    }
    sampleLights(tile, block, bounce);
    scatter(tile, block, bounce);
}

void finish(const Tile& tile)
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        const std::size_t bytes = sizeof(FloatLanes);
        std::memcpy(&tile.result.rgba[b].r, tile.sums.r + b * kLanes, bytes);
        std::memcpy(&tile.result.rgba[b].g, tile.sums.g + b * kLanes, bytes);
        std::memcpy(&tile.result.rgba[b].b, tile.sums.b + b * kLanes, bytes);
        std::memcpy(&tile.result.rgba[b].a, tile.sums.a + b * kLanes, bytes);
    }
    dropNotFinite(tile.result);
}

template <PhotonUse use> void tracePaths(Tile& tile)
{
    const PassContext& context = tile.context;
    for (int b = 0; b < kTileBlocks; ++b)
    {
        PathBlock& block = tile.paths.blocks[b];
        cameraRayLanes(context.camera, context.pathKey, tile.left, tile.bottom, b, false, block.rays,
                       block.seed);
        for (int i = 0; i < kLanes; ++i)
        {
            setLane(block.throughput, i, Vec3(1.0f));
            block.pdfW[i] = kInfinity;
            block.etaScale[i] = 1.0f;
            block.pixel[i] = static_cast<uint32_t>(b * kLanes + i);
        }
        block.active = kAllLanes;
    }
    for (int number = 0; tile.paths.count > 0; ++number)
    {
        const bool last = number >= context.options.maxBounces;
        for (int b = 0; b < tile.paths.count; ++b)
            bounceBlock<use>(tile, b, number, last);
        closeRanks(tile.paths);
    }
    finish(tile);
}

} // namespace

void PathIntegrator::renderTile(const PassContext& context, int left, int bottom,
                                TileResult& result) const
{
    Tile tile(context, left, bottom, result);
    switch (context.photons ? context.photonUse : PhotonUse::None)
    {
    case PhotonUse::None: return tracePaths<PhotonUse::None>(tile);
    case PhotonUse::Caustics: return tracePaths<PhotonUse::Caustics>(tile);
    case PhotonUse::Indirect: return tracePaths<PhotonUse::Indirect>(tile);
    }
}

} // namespace osgRayTrace::engine
