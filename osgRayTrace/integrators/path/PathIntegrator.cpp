// PathIntegrator.cpp - follows the paths of a tile, bounce by bounce. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// Unidirectional path tracing is the reference for everything else. The radiance along a camera ray
// has this estimator [Kajiya86; Veach97, ch. 8 and 9]:
//
//   L = sum over bounces k of beta_k * ( w_bsdf Le(x_k) + w_light f cos Le(y) V / (pmf pdfW)
//                                        + sum over delta lights of f cos pi I V )
//   beta_{k+1} = beta_k f cos / pdfW / q
//
// The weights w = p_a^2 / (p_a^2 + p_b^2) are those of the power heuristic, y is sampled on one
// light that a LightTree chooses for x_k, or on each of a few area lights (PathCandidates.cpp has
// one shadow ray for them all), and q is the survival probability of Russian roulette. The
// probability q is 1 while beta is above a bound, and is beta over this bound below the bound, so
// that beta stays at the bound. For q, beta is taken as it would be outside of all glass, because
// beta in glass is 1/eta^2 of the beta that comes out again. A q that is capped below 1 would let
// beta, and with beta the variance, grow along paths that lose less than q takes. Sixteen paths are
// followed together; after each bounce the tile's remaining paths move up into the lanes of those
// that ended. The light that a path finds from its second surface on is shared with other pixels,
// see PathReuse.cpp. Paths from one glossy surface to another get company, see PathChains.cpp.
#include "osgRayTrace/integrators/path/PathIntegrator.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/NormalMaps.h"
#include "osgRayTrace/accel/SurfaceTangents.h"
#include "osgRayTrace/integrators/path/PathMedium.h"
#include "osgRayTrace/integrators/shared/CameraLanes.h"
#include "osgRayTrace/integrators/shared/FirstHit.h"
#include "osgRayTrace/integrators/shared/FogLanes.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/Panes.h"
#include "osgRayTrace/integrators/shared/ShadowCatcher.h"
#include "osgRayTrace/shading/SmoothLanes.h"

#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

/// Sets the normals of a bounce, its BSDFs and albedos, and the sets of lanes by kind of surface.
void classify(const Tile& tile, const PathBlock& block, Bounce& bounce)
{
    facingNormalLanes(block.rays.ray, bounce.surface, bounce.normal);
    const MaterialTable& materials = tile.context.traced->materials();
    const SceneTraits& traits = tile.context.traced->traits();
    const MediumTable* media = traits.media ? &tile.context.traced->media() : nullptr;
    bounce.diffuse = bounce.general = bounce.smooth = bounce.transmissive = bounce.subsurface = 0;
    for (const int i : lanesIn(bounce.surface.hits))
    {
        const MaterialRecord& record = materials[bounce.surface.material[i]];
        if (record.plainDiffuse)
        {
            setLane(bounce.albedo, i, record.front.diffuse);
            const bool black = record.front.diffuse == Vec3(0.0f);
            bounce.diffuse |= static_cast<LaneMask>(!black) << i;
            continue;
        }
        const bool front = (bounce.surface.front >> i) & 1u;
        bounce.bsdfs[i] =
            record.constant
                ? (front ? record.front : record.back)
                : materials.bsdf(bounce.surface.material[i],
                                 materialPoint(tile.context, block.rays, bounce.surface, i));
        if (media)
            setRelativeIor(*media, block.bodies[i], media->interiorOf(bounce.surface.material[i]),
                           front, bounce.bsdfs[i]);
        if (record.pane) dropStraightLobe(bounce.bsdfs[i]);
        if (bounce.bsdfs[i].needsAxes())
            alignLayers(*tile.context.traced, block.rays, bounce.surface, i,
                        laneOf(bounce.normal, i), bounce.bsdfs[i]);
        if (bounce.bsdfs[i].isDiffuse() && bounce.bsdfs[i].diffuse == Vec3(0.0f)) continue;
        bounce.general |= 1u << i;
        bounce.subsurface |= static_cast<LaneMask>(record.subsurface && front) << i;
        bounce.smooth |= static_cast<LaneMask>(isSmoothInterface(bounce.bsdfs[i])) << i;
        bounce.transmissive |= static_cast<LaneMask>(bounce.bsdfs[i].passesLight()) << i;
    }
    dropTerminatorOffset(bounce.surface,
                         bounce.transmissive); // refraction needs the facet's own place
}

/// Applies what materials do to light on its way, before surfaces are shaded.
void passMaterials(Tile& tile, PathBlock& block, Bounce& bounce, int number)
{
    const TracedScene& traced = *tile.context.traced;
    const HitRule rule = number == 0 ? kCameraRays : HitRule();
    if (traced.traits().panes && !traced.traits().media) // travelMedia has passed panes
        bounce.behindPanes = passPanes(
            tile.context, {block.rays, block.active, rule, bounce.surface, block.throughput},
            tile.counts);
    if (traced.traits().panes && traced.traits().mipmaps)
        setFootprints(block.rays.ray, block.cones, bounce.surface);
    if (traced.traits().attenuation && !traced.traits().media)
        attenuate(tile.context, block.rays, bounce.surface, block.throughput);
}

/// Puts fog between the eye and what it sees, also by way of mirrors.
void addFog(Tile& tile, PathBlock& block, const Bounce& bounce)
{
    LaneMask mirrored = 0;
    for (const int i : lanesIn(bounce.number > 0 ? bounce.surface.hits : 0))
        mirrored |= static_cast<LaneMask>(!block.flagsOf(i).isScattered()) << i;
    const LaneMask fromCamera = bounce.number == 0 ? bounce.surface.hits & ~bounce.collided : 0;
    FogLanes fog;
    fogOf(tile.context, {block.rays, bounce.surface, fromCamera, mirrored}, block.depth, fog);
    for (const int i : lanesIn(fog.lanes))
    {
        const Vec3 throughput = laneOf(block.throughput, i);
        tile.sums.add(block.flagsOf(i), throughput * laneOf(fog.added, i));
        setLane(block.throughput, i, throughput * fog.share[i]);
    }
}

/// Lets the shadows on the ground take light from what the eye sees behind it, also by way of
/// mirrors.
void passGround(Tile& tile, PathBlock& block, int number)
{
    LaneMask seeing = 0;
    for (const int i : lanesIn(block.active))
        seeing |= static_cast<LaneMask>(!block.flagsOf(i).isScattered()) << i;
    CaughtShadows caught;
    catchShadows(tile.context, {block.rays, seeing, block.seed, static_cast<uint32_t>(number)},
                 tile.counts, caught);
    for (const int i : lanesIn(caught.lanes))
    {
        setLane(block.throughput, i, laneOf(block.throughput, i) * caught.share[i]);
        if (number == 0) tile.sums.a[block.flagsOf(i).pixel()] = 1.0f - caught.share[i];
    }
}

/// Takes the paths of a block through media. What is seen first is what stands behind the media.
LaneMask throughMedia(Tile& tile, int b, int number, bool last, PhotonUse use)
{
    PathBlock& block = tile.paths.blocks[b];
    if (number == 0)
    {
        SurfaceLanes seen;
        surfacesOf(tile.context.traced->surfaces(), block.rays, block.active, seen,
                   rayStart(tile.context.options));
        if (tile.context.traced->traits().mipmaps) setFootprints(block.rays.ray, block.cones, seen);
        recordFirstHits(tile.context, tile.left, tile.bottom, b, block.rays, seen,
                        tile.result.firstHits);
    }
    return travelMedia(tile, block, number, last, use);
}

/// Adds the light of a bounce some of whose surfaces let light into their bodies.
void addSubsurface(Tile& tile, PathBlock& block, Bounce& bounce, PhotonUse use)
{
    SubsurfaceLanes lanes;
    partSubsurface(tile, block, bounce, lanes);
    addLightAt(tile, block, bounce, use);
    walkBelowSurfaces(tile, block, bounce, lanes, use);
}

/// Traces the paths of a block over one bounce.
void bounceBlock(Tile& tile, int b, int number, bool last, PhotonUse use)
{
    PathBlock& block = tile.paths.blocks[b];
    const TracedScene& traced = *tile.context.traced;
    const Coherence coherence = number == 0 ? Coherence::Coherent : Coherence::Incoherent;
    traced.intersector().closestHits(block.rays, block.active, coherence,
                                     number == 0 ? kCameraRays : HitRule());
    const auto rays = static_cast<uint64_t>(countLanes(block.active));
    (number == 0 ? tile.counts.cameraRays : tile.counts.secondaryRays) += rays;
    countRays(tile, block, block.active);

    const SceneTraits& traits = traced.traits();
    if (traits.ground) passGround(tile, block, number);
    Bounce bounce;
    bounce.number = number;
    bounce.bsdfs = tile.bsdfs;
    if (traits.media) bounce.collided = throughMedia(tile, b, number, last, use);
    surfacesOf(traced.surfaces(), block.rays, block.active, bounce.surface,
               rayStart(tile.context.options));
    if (traits.normalMaps) applyNormalMaps(traced, block.rays, bounce.surface);
    if (traits.mipmaps) setFootprints(block.rays.ray, block.cones, bounce.surface);
    if (number == 0 &&
        !traits.media) // a pane is what is seen first, also by rays that go on behind it
        recordFirstHits(tile.context, tile.left, tile.bottom, b, block.rays, bounce.surface,
                        tile.result.firstHits);
    if (traits.panes || traits.attenuation) passMaterials(tile, block, bounce, number);
    const LaneMask missed = block.active & ~bounce.surface.hits;
    addEnvironment(tile, block, missed & ~bounce.collided, number, use);
    if (bounce.collided) addEnvironment(tile, block, missed & bounce.collided, number + 1, use);
    if (traits.fog) addFog(tile, block, bounce);
    addEmission(tile, block, bounce.surface, number, use);
    for (const int i : lanesIn(number == 0 ? bounce.surface.hits : 0))
        tile.sums.a[block.flagsOf(i).pixel()] = 1.0f;
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
    if (number == 1 && tile.reuse.active) reusePaths(tile, block, bounce);
    if (number == 1 && tile.chains.active) countChains(tile, block, bounce);
    if (bounce.subsurface)
        addSubsurface(tile, block, bounce, use);
    else
        addLightAt(tile, block, bounce, use);
    if (number == 0 && tile.reuse.active) recordFirstSurfaces(tile, b, bounce);
    if (number == 0 && tile.chains.active) recordGlossy(tile, b, bounce);
    if (traced.lights().tree())
        block.vertices = treePoints(bounce.surface, bounce.normal, bounce.transmissive);
    scatter(tile, block, bounce);
    if (traits.media) enterBodies(tile, block, bounce);
}

void tracePaths(Tile& tile, PhotonUse use)
{
    const PassContext& context = tile.context;
    const bool media = context.traced->traits().media;
    const MediumStack around = media ? bodiesAround(*context.traced, context.eye) : MediumStack();
    const LaneMask* wanted = tile.result.wanted;
    for (int b = 0; b < kTileBlocks; ++b)
    {
        PathBlock& block = tile.paths.blocks[b];
        block.active = wanted ? wanted[b] : kAllLanes;
        if (!block.active) continue;
        cameraRayLanes(context.camera, context.pathKey, tile.left, tile.bottom, b,
                       context.throughCentres, block.rays, block.seed);
        if (context.traced->traits().mipmaps) cameraCones(context, block.rays.ray, block.cones);
        for (int i = 0; i < kLanes; ++i)
        {
            setLane(block.throughput, i, Vec3(1.0f));
            block.pdfW[i] = kInfinity;
            block.etaScale[i] = 1.0f;
            block.bodies[i] = around;
            block.flags[i] = PathFlags::ofPixel(static_cast<uint32_t>(b * kLanes + i)).word();
        }
    }
    beginReuse(tile, use);
    beginSkyRays(tile, use);
    beginSunSpots(tile);
    beginChains(tile, use);
    for (int number = 0; tile.paths.count > 0; ++number)
    {
        const bool last = number >= context.options.maxBounces;
        for (int b = 0; b < tile.paths.count; ++b)
            if (tile.paths.blocks[b].active) bounceBlock(tile, b, number, last, use);
        if (number == 1 && tile.chains.active) addCompanions(tile, use);
        compactPaths(tile.paths, context.traced->lights().tree() != nullptr);
    }
    connectPaths(tile);
    addChains(tile);
}

void writeSums(const Tile& tile, RgbaLanes* rgba)
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        const std::size_t bytes = sizeof(FloatLanes);
        std::memcpy(&rgba[b].r, tile.sums.r + b * kLanes, bytes);
        std::memcpy(&rgba[b].g, tile.sums.g + b * kLanes, bytes);
        std::memcpy(&rgba[b].b, tile.sums.b + b * kLanes, bytes);
        std::memcpy(&rgba[b].a, tile.sums.a + b * kLanes, bytes);
    }
}

void readSums(const RgbaLanes* rgba, Tile& tile)
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        const std::size_t bytes = sizeof(FloatLanes);
        std::memcpy(tile.sums.r + b * kLanes, &rgba[b].r, bytes);
        std::memcpy(tile.sums.g + b * kLanes, &rgba[b].g, bytes);
        std::memcpy(tile.sums.b + b * kLanes, &rgba[b].b, bytes);
        std::memcpy(tile.sums.a + b * kLanes, &rgba[b].a, bytes);
    }
}

/// Renders a pass of [Hachisuka08, sect. 4]: camera paths are traced once, and photons and light
/// are gathered at the kept hit points until the pass has other paths.
void gatherOnly(Tile& tile, PhotonUse use)
{
    HitPoints& hits = *tile.result.photons.hitPoints;
    const uint32_t paths = tile.context.pathKey.index;
    if (hits.paths == paths)
        readSums(hits.seen.data(), tile);
    else
    {
        hits.clear();
        tracePaths(tile, use);
        hits.seen.resize(kTileBlocks);
        writeSums(tile, hits.seen.data());
        hits.blocks.shrink_to_fit();
        hits.bsdfs.shrink_to_fit();
        hits.paths = paths;
    }
    gatherAtHitPoints(tile, hits);
}

} // namespace

void bounceCompanions(Tile& tile, PathBlock& block, PhotonUse use)
{
    const TracedScene& traced = *tile.context.traced;
    const SceneTraits& traits = traced.traits();
    traced.intersector().closestHits(block.rays, block.active, Coherence::Incoherent, HitRule());
    tile.counts.secondaryRays += static_cast<uint64_t>(countLanes(block.active));
    countRays(tile, block, block.active);
    Bounce bounce;
    bounce.number = 1;
    bounce.bsdfs = tile.bsdfs;
    surfacesOf(traced.surfaces(), block.rays, block.active, bounce.surface,
               rayStart(tile.context.options));
    if (traits.normalMaps) applyNormalMaps(traced, block.rays, bounce.surface);
    if (traits.mipmaps) setFootprints(block.rays.ray, block.cones, bounce.surface);
    if (traits.panes || traits.attenuation) passMaterials(tile, block, bounce, bounce.number);
    classify(tile, block, bounce);
    block.active &= glossyLanes(bounce);
    if (!block.active) return;
    bounce.surface.hits &= block.active;
    bounce.general &= block.active;
    bounce.diffuse = bounce.smooth = bounce.transmissive = bounce.subsurface = 0;
    countChains(tile, block, bounce);
    addLightAt(tile, block, bounce, use);
    if (traced.lights().tree())
        block.vertices = treePoints(bounce.surface, bounce.normal, bounce.transmissive);
    scatter(tile, block, bounce);
}

void PathIntegrator::renderTile(const PassContext& context, int left, int bottom,
                                TileResult& result) const
{
    Tile tile(context, left, bottom, result);
    const PhotonUse use = context.photons ? context.photonUse : PhotonUse::None;
    if (result.photons.hitPoints)
        gatherOnly(tile, use);
    else
        tracePaths(tile, use);
    takeBlur(tile);
    writeSums(tile, result.rgba);
    dropNotFinite(result);
}

} // namespace osgRayTrace::engine
