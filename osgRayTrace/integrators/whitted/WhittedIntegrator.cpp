// WhittedIntegrator.cpp - direct light, shadows, mirrors and glass. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// The radiance L along a ray is
//
//   L(ray) = emission + direct light                                  all surfaces
//          + reflection L(mirror ray) + refraction L(refracted ray)   smooth surfaces
//
// If a surface of opacity a is blended, the radiance is a L(surface) + (1 - a) L(the ray that goes
// on). Direct light is the mean of f cos L V / pdfW over the samples of each area light and of the
// environment (or the sum over the strata of the environment), plus the fixed-function or physical
// response to each directional, point and spot light. Mirror rays, refracted rays and rays that go
// on are pushed on a stack, and up to sixteen at a time are taken from its top.
#include "osgRayTrace/integrators/whitted/WhittedIntegrator.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/NormalMaps.h"
#include "osgRayTrace/accel/SurfaceTangents.h"
#include "osgRayTrace/integrators/shared/CameraLanes.h"
#include "osgRayTrace/integrators/shared/EnvironmentLanes.h"
#include "osgRayTrace/integrators/shared/FirstHit.h"
#include "osgRayTrace/integrators/shared/Panes.h"
#include "osgRayTrace/integrators/whitted/WhittedTile.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns whether all hits are on the material first.
OSGRAYTRACE_KERNEL
bool isOneMaterial(const UintLanes& material, LaneMask hits, uint32_t first)
{
    uint32_t differs = 0;
    OSGRAYTRACE_SIMD_OR(differs)
    for (int i = 0; i < kLanes; ++i)
        differs |= (material[i] ^ first) & laneBit(hits, i);
    return differs == 0;
}

OSGRAYTRACE_KERNEL
void fill(Vec3 value, Vec3Lanes& lanes)
{
    const float x = value.x, y = value.y, z = value.z;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        lanes.x[i] = x;
        lanes.y[i] = y;
        lanes.z[i] = z;
    }
}

/// Returns true if the scene has lights for which fixed-function surfaces need a Bsdf.
bool lightsArea(const PassContext& context)
{
    return context.traced->traits().areaLights || context.traced->traits().environment;
}

/// Sets what OpenGL's lights need of the fixed-function surface of lane i.
void setFixedFunction(const WhittedTile& tile, ShadingBlock& block, int i)
{
    const PassContext& context = tile.context;
    LaneMaterials& m = block.materials;
    const MaterialPoint point = materialPoint(context, block.rays, block.surface, i);
    m.points[i] = fixedFunctionPoint(context, block.rays, block.surface, i, point);
    if (lightsArea(context))
        m.bsdfs[i] = context.traced->materials().bsdf(block.surface.material[i], point);
    m.fixedFunction |= 1u << i;
    // OpenGL lights by the vertex normal alone, which may point away from the side of the face.
    m.transmissive |= 1u << i;
    if (!(glm::dot(m.points[i].normal, laneOf(block.surface.geometricNormal, i)) > 0.0f))
        dropTerminatorOffset(block.surface, 1u << i);
}

void classify(WhittedTile& tile, ShadingBlock& block)
{
    LaneMaterials& m = block.materials;
    m.diffuse = m.fixedFunction = m.physical = m.transmissive = m.emissive = m.partial = 0;
    facingNormalLanes(block.rays.ray, block.surface, m.normal);
    const MaterialTable& materials = tile.context.traced->materials();
    const LaneMask hits = block.surface.hits;
    if (!hits) return;
    const uint32_t first = block.surface.material[firstLane(hits)];
    const MaterialRecord& firstRecord = materials[first];
    if (firstRecord.plainDiffuse && !firstRecord.emits && !firstRecord.fixedFunction &&
        isOneMaterial(block.surface.material, hits, first))
    {
        fill(firstRecord.front.diffuse, m.albedo);
        if (firstRecord.front.diffuse != Vec3(0.0f)) m.diffuse = hits;
        if (firstRecord.partial) m.partial = hits;
        return;
    }
    if (tile.bsdfs.empty())
    {
        tile.bsdfs.resize(kGroup * kLanes);
        tile.points.resize(kGroup * kLanes);
    }
    const std::ptrdiff_t slot = (&block - tile.group) * kLanes;
    m.bsdfs = &tile.bsdfs[static_cast<std::size_t>(slot)];
    m.points = &tile.points[static_cast<std::size_t>(slot)];
    for (const int i : lanesIn(block.surface.hits))
    {
        const uint32_t material = block.surface.material[i];
        const MaterialRecord& record = materials[material];
        m.emissive |= static_cast<LaneMask>(record.emits || record.fixedFunction) << i;
        m.partial |= static_cast<LaneMask>(record.partial) << i;
        if (record.fixedFunction)
        {
            if (record.material->lit) setFixedFunction(tile, block, i);
            continue; // without light all that it sends is emission
        }
        if (record.plainDiffuse)
        {
            setLane(m.albedo, i, record.front.diffuse);
            m.diffuse |= static_cast<LaneMask>(record.front.diffuse != Vec3(0.0f)) << i;
            continue;
        }
        const bool front = (block.surface.front >> i) & 1u;
        m.bsdfs[i] = record.constant
                         ? (front ? record.front : record.back)
                         : materials.bsdf(
                               material, materialPoint(tile.context, block.rays, block.surface, i));
        m.physical |= 1u << i;
        if (m.bsdfs[i].needsAxes())
            alignLayers(*tile.context.traced, block.rays, block.surface, i, laneOf(m.normal, i),
                        m.bsdfs[i]);
        if (!m.bsdfs[i].passesLight()) continue;
        m.transmissive |= 1u << i;
        dropTerminatorOffset(block.surface, 1u << i); // refraction depends on where the facet is
    }
}

/// Adds the light that surfaces send by themselves, and the colours of fixed-function surfaces.
void addOwnLight(const WhittedTile& tile, ShadingBlock& block)
{
    const LaneMaterials& m = block.materials;
    for (const int i : lanesIn(m.emissive))
    {
        if ((m.fixedFunction >> i) & 1u)
            addLane(block.radiance, i, litColor(tile.context, m.points[i]));
        else
            addLane(block.radiance, i,
                    emissionTowardsRay(tile.context, block.rays, block.surface, i));
    }
}

/// Finds the fog of the hits. Rays that go on behind a blended mirror start at the depth of the
/// mirror, like all rays of its point.
void findFog(const WhittedTile& tile, ShadingBlock& block)
{
    fogOf(tile.context, {block.rays, block.surface, block.fromCamera, kAllLanes}, block.fogDepths,
          block.fog);
}

void addFog(ShadingBlock& block)
{
    for (const int i : lanesIn(block.fog.lanes))
        setLane(block.radiance, i,
                laneOf(block.radiance, i) * block.fog.share[i] + laneOf(block.fog.added, i));
}

/// Sets the radiance of all hits of some blocks of the group (lanes without a hit are undefined),
/// and pushes the rays that go on.
void shade(WhittedTile& tile, ShadingBlock* blocks, int count)
{
    for (ShadingBlock* block = blocks; block != blocks + count; ++block)
    {
        const SceneTraits& traits = tile.context.traced->traits();
        if (traits.normalMaps) applyNormalMaps(*tile.context.traced, block->rays, block->surface);
        if (traits.mipmaps) followCones(*block);
        if (traits.fog) findFog(tile, *block);
        classify(tile, *block);
        fill(Vec3(0.0f), block->radiance);
        block->passed = traits.blended && block->materials.partial ? passThrough(tile, *block) : 0;
        if (traits.attenuation)
            block->passed |= attenuate(tile.context, block->rays, block->surface, block->weight);
        if (traits.media || traits.ground) block->passed |= block->dimmed;
    }
    addDirectLight(tile, blocks, count);
    for (ShadingBlock* block = blocks; block != blocks + count; ++block)
    {
        if (block->materials.emissive) addOwnLight(tile, *block);
        if (block->fog.lanes) addFog(*block);
        if (block->materials.physical) spawn(tile, *block);
    }
}

/// Traces up to sixteen rays from the top of the stack.
void traceSecondary(WhittedTile& tile)
{
    const TracedScene& traced = *tile.context.traced;
    ShadingBlock& block = tile.group[0];
    LaneMask active = 0;
    block.fromCamera = 0;
    // Rays from the camera are taken apart from other rays, as they meet other surfaces.
    const bool fromCamera = tile.stack.back().fromCamera;
    const bool seen = visibleEnvironment(tile.context) != nullptr;
    for (int i = 0; i < kLanes && !tile.stack.empty() && tile.stack.back().fromCamera == fromCamera;
         ++i)
    {
        const SecondaryRay& from = tile.stack.back();
        setRay(block.rays.ray, i, from.begin, from.direction, kInfinity);
        setLane(block.weight, i, from.weight);
        block.etaScale[i] = from.etaScale;
        block.pixel[i] = from.pixel;
        block.seed[i] = from.seed;
        block.depth[i] = from.depth;
        block.layers[i] = from.layers;
        setLane(block.cones, i, from.cone);
        block.fogDepths[i] = from.fogDepth;
        active |= 1u << i;
        if (fromCamera) block.fromCamera |= 1u << i;
        tile.stack.pop_back();
    }
    traced.intersector().closestHits(block.rays, active, Coherence::Incoherent, {fromCamera, true});
    tile.result.counts.secondaryRays += static_cast<uint64_t>(countLanes(active));
    countRays(tile, block, active);
    surfacesOf(traced.surfaces(), block.rays, active, block.surface,
               rayStart(tile.context.options));
    if (traced.traits().media)
    {
        addAir(tile, block, active);
        for (const int i : lanesIn(block.dimmed))
            tile.add(block.pixel[i], laneOf(block.air, i));
    }
    if (traced.traits().ground) passGround(tile, block, active);
    for (const int i : lanesIn(active & ~block.surface.hits))
    {
        if (fromCamera && !seen)
            tile.uncover(block.pixel[i], block.weight.x[i]);
        else
            tile.add(block.pixel[i],
                     laneOf(block.weight, i) * radianceBehind(tile.context, block.rays.ray, i));
    }
    if (!block.surface.hits) return;
    drawFirstPoints(tile, block);
    shade(tile, &block, 1);
    for (const int i : lanesIn(block.surface.hits))
        tile.add(block.pixel[i], laneOf(block.weight, i) * laneOf(block.radiance, i));
}

OSGRAYTRACE_KERNEL
void weigh(const Vec3Lanes& weight, Vec3Lanes& radiance)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        radiance.x[i] *= weight.x[i];
        radiance.y[i] *= weight.y[i];
        radiance.z[i] *= weight.z[i];
    }
}

OSGRAYTRACE_KERNEL
void setPixels(const Vec3Lanes& radiance, LaneMask hits, RgbaLanes& rgba)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const uint32_t hit = laneBit(hits, i);
        rgba.r[i] = select(hit, radiance.x[i], 0.0f);
        rgba.g[i] = select(hit, radiance.y[i], 0.0f);
        rgba.b[i] = select(hit, radiance.z[i], 0.0f);
        rgba.a[i] = select(hit, 1.0f, 0.0f);
    }
}

/// Sets the weights and pixels of the camera rays of a block, whose pixels are those from
/// firstPixel on.
OSGRAYTRACE_KERNEL
void startCamera(uint32_t firstPixel, ShadingBlock& block)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        block.pixel[i] = firstPixel + static_cast<uint32_t>(i);
        block.weight.x[i] = block.weight.y[i] = block.weight.z[i] = 1.0f;
        block.etaScale[i] = 1.0f;
        block.depth[i] = block.layers[i] = 0;
    }
    block.fromCamera = kAllLanes;
}

/// Adds the air before the hits of camera rays. The background shows through what is left of its
/// light.
void showAir(WhittedTile& tile, const ShadingBlock& block, RgbaLanes& rgba)
{
    for (const int i : lanesIn(block.dimmed))
    {
        tile.add(block.pixel[i], laneOf(block.air, i));
        const Vec3 left = laneOf(block.weight, i);
        const float cover = std::max(0.0f, 1.0f - (left.x + left.y + left.z) / 3.0f);
        if (!((block.surface.hits >> i) & 1u)) rgba.a[i] = std::max(rgba.a[i], cover);
    }
}

/// The rule of camera rays. A constant is handed over faster than a temporary, which the call waits
/// for.
constexpr HitRule kFromCamera{true, true};

/// Traces the camera rays of some lanes of blocks first to first + kGroup - 1, stage by stage.
void traceCamera(WhittedTile& tile, int left, int bottom, int first, const LaneMask* lanes)
{
    const PassContext& context = tile.context;
    const TracedScene& traced = *context.traced;
    const bool seen = visibleEnvironment(context) != nullptr;
    for (int k = 0; k < kGroup; ++k)
    {
        ShadingBlock& block = tile.group[k];
        cameraRayLanes(context.camera, context.key, left, bottom, first + k, context.throughCentres,
                       block.rays, block.seed);
        startCamera(static_cast<uint32_t>((first + k) * kLanes), block);
        if (traced.traits().mipmaps) cameraCones(context, block.rays.ray, block.cones);
        drawFirstPoints(tile, block);
    }
    for (int k = 0; k < kGroup; ++k)
        traced.intersector().closestHits(tile.group[k].rays, lanes[k], Coherence::Coherent,
                                         kFromCamera);
    for (int k = 0; k < kGroup; ++k)
    {
        ShadingBlock& block = tile.group[k];
        surfacesOf(traced.surfaces(), block.rays, lanes[k], block.surface,
                   rayStart(context.options), &tile.lastTriangle);
        tile.result.counts.cameraRays += static_cast<uint64_t>(countLanes(lanes[k]));
    }
    const bool media = traced.traits().media;
    for (int k = 0; media && k < kGroup; ++k)
        addAir(tile, tile.group[k], lanes[k]);
    const bool ground = traced.traits().ground;
    for (int k = 0; ground && k < kGroup; ++k)
        passGround(tile, tile.group[k], lanes[k]);
    shade(tile, tile.group, kGroup);
    for (int k = 0; k < kGroup; ++k)
    {
        ShadingBlock& block = tile.group[k];
        countRays(tile, block, lanes[k]);
        if (block.passed) weigh(block.weight, block.radiance);
        recordFirstHits(context, left, bottom, first + k, block.rays, block.surface,
                        tile.result.firstHits);
        RgbaLanes& rgba = tile.result.rgba[first + k];
        setPixels(block.radiance, block.surface.hits, rgba);
        for (const int i : lanesIn(seen ? lanes[k] & ~block.surface.hits : 0))
        {
            const Vec3 behind = radianceBehind(context, block.rays.ray, i);
            tile.add(block.pixel[i], media || ground ? behind * laneOf(block.weight, i) : behind);
            rgba.a[i] = 1.0f;
        }
        if (media || ground) showAir(tile, block, rgba);
    }
}

} // namespace

void WhittedIntegrator::renderTile(const PassContext& context, int left, int bottom,
                                   TileResult& result) const
{
    WhittedTile tile(context, result);
    constexpr LaneMask kAll[kGroup] = {kAllLanes, kAllLanes, kAllLanes, kAllLanes};
    for (int first = 0; first < kTileBlocks; first += kGroup)
    {
        const LaneMask* const lanes = result.wanted ? result.wanted + first : kAll;
        const auto isWanted = [](LaneMask block) { return block != 0; };
        if (std::none_of(lanes, lanes + kGroup, isWanted)) continue;
        traceCamera(tile, left, bottom, first, lanes);
        while (!tile.stack.empty())
            traceSecondary(tile);
    }
    dropNotFinite(result);
}

} // namespace osgRayTrace::engine
