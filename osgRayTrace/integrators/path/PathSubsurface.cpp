// PathSubsurface.cpp - paths that walk below diffuse boundaries: skin, wax. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// A surface with subsurface scattering has two parts: what it scatters where light meets it, and
// the light that leaves it after it has entered elsewhere. A path that comes from the eye takes
// that light's way back. The radiance along its ray is
//
//   L = L_local + A(wo) share integral over walks of beta L_leaving(y)
//
// where y is where the walk leaves (SubsurfaceWalk.h) and L_leaving that of the inner side of the
// base there (LayeredBsdf.h). L_local is sampled for all paths. Of both ways on, one is chosen with
// the probability p that a sample of the whole surface would have been one of its base; the other
// lobes go on with 1 / (1 - p). At y paths are what they are on a diffuse surface: lights are
// sampled, photons are looked up, pixels share what is found. A walk that leaves its mesh through a
// hole comes back as plain diffuse reflection.
#include "osgRayTrace/accel/Bodies.h"
#include "osgRayTrace/accel/MergeHits.h"
#include "osgRayTrace/accel/NormalMaps.h"
#include "osgRayTrace/accel/SubsurfaceWalk.h"
#include "osgRayTrace/accel/SurfaceTangents.h"
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/HitShading.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

constexpr uint32_t kBelow = 0x736b696eu; ///< tells the dimensions of walks from all others

/// Names the numbers of a walk.
enum WalkDimension : uint32_t
{
    WalkChoice = 0,    ///< x: whether the path walks
    WalkDirection = 1, ///< first direction
    WalkCollisions = 2 ///< a seed
};

uint32_t seedOf(const PathBlock& block, int number, int i, WalkDimension dimension)
{
    return dimensionSeed(block.seed[i],
                         hash(kBelow + static_cast<uint32_t>(number), uint32_t(dimension)));
}

/// Returns two Sobol numbers of a walk.
Vec2 numbersOf(const Tile& tile, const PathBlock& block, int number, int i, WalkDimension dimension)
{
    Vec2 u;
    sobol2(tile.context.pathKey.index, seedOf(block, number, i, dimension), u.x, u.y);
    return u;
}

/// Returns whether light samples and photons find nothing on what is left of a surface.
bool isHidden(const Bsdf& local)
{
    if (local.diffuse != Vec3(0.0f) || local.diffuseTransmission != Vec3(0.0f)) return false;
    if (local.sheen != Vec3(0.0f) || (local.clearcoat > 0.0f && local.clearcoatAlpha > 0.0f))
        return false;
    return local.isSmooth() || !(local.reflects() || local.transmits());
}

/// Returns whether light leaves a body as from a Lambert surface, without layers.
bool isBare(const Bsdf& leaving)
{
    return leaving.coat == 0.0f && leaving.clearcoat == 0.0f && leaving.sheen == Vec3(0.0f);
}

/// Makes a lane one that scatters in the way of its new surface alone.
void setLeaving(Bounce& bounce, int i, const Bsdf& leaving, Vec3 color)
{
    const LaneMask lane = 1u << i;
    for (LaneMask* mask : {&bounce.diffuse, &bounce.general, &bounce.smooth, &bounce.transmissive,
                           &bounce.gathering, &bounce.rough, &bounce.carried, &bounce.terminating})
        *mask &= ~lane;
    if (isBare(leaving))
    {
        bounce.diffuse |= lane;
        setLane(bounce.albedo, i, color);
        return;
    }
    bounce.general |= lane;
    bounce.bsdfs[i] = leaving;
    bounce.bsdfs[i].diffuse = color;
}

/// Walks below the surface of a lane.
SubsurfaceWalk walk(const Tile& tile, const PathBlock& block, const Bounce& bounce, int i,
                    const SubsurfaceLanes& lanes, Vec3 throughput)
{
    const SurfaceLanes& surface = bounce.surface;
    SubsurfaceEntry entry;
    entry.position = laneOf(trianglePoints(surface), i);
    entry.normal = laneOf(surface.geometricNormal, i);
    entry.offset = surface.offset[i];
    entry.sigma = lanes.sigma[i];
    entry.color = lanes.split[i].color;
    entry.throughput = throughput;
    entry.least = kRouletteThroughput / block.etaScale[i];
    entry.direction = numbersOf(tile, block, bounce.number, i, WalkDirection);
    entry.key = hash(seedOf(block, bounce.number, i, WalkCollisions), tile.context.pathKey.index);
    return walkBelow(*tile.context.traced, entry);
}

/// Returns a point just before a surface, on the side of its normal.
Vec3 pointBefore(const SurfaceLanes& surface, int i)
{
    return laneOf(trianglePoints(surface), i) +
           laneOf(surface.geometricNormal, i) * surface.offset[i];
}

/// Takes lanes of the bounce to the surfaces of a block of rays that leave them.
void leaveThere(Tile& tile, RayHitBlock& leaving, LaneMask lanes, PathBlock& block, Bounce& bounce)
{
    const TracedScene& traced = *tile.context.traced;
    SurfaceLanes surface;
    surfacesOf(traced.surfaces(), leaving, lanes, surface, rayStart(tile.context.options));
    if (traced.traits().normalMaps) applyNormalMaps(traced, leaving, surface);
    Vec3Lanes normal;
    facingNormalLanes(leaving.ray, surface, normal);
    mergeHits(leaving, surface, lanes, block.rays, bounce.surface);
    for (const int i : lanesIn(lanes))
    {
        setLane(bounce.normal, i, laneOf(normal, i));
        const Vec3 origin(leaving.ray.originX[i], leaving.ray.originY[i], leaving.ray.originZ[i]);
        setRay(block.rays.ray, i, plainOf(origin), plainDirection(leaving.ray, i), 0.0f,
               leaving.ray.tFar[i]);
        Bsdf bsdf = leavingBody(traced.materials().bsdf(
            surface.material[i], materialPoint(tile.context, block.rays, bounce.surface, i)));
        if (bsdf.needsAxes())
            alignLayers(traced, block.rays, bounce.surface, i, laneOf(normal, i), bsdf);
        if (traced.media().hasInteriors())
            block.bodies[i] = bodiesAround(traced, pointBefore(bounce.surface, i));
        setLeaving(bounce, i, bsdf, Vec3(1.0f));
    }
}

} // namespace

void partSubsurface(const Tile& tile, const PathBlock& block, Bounce& bounce,
                    SubsurfaceLanes& lanes)
{
    const MaterialTable& materials = tile.context.traced->materials();
    for (const int i : lanesIn(bounce.subsurface))
    {
        Bsdf& bsdf = bounce.bsdfs[i];
        const ShadingFrame frame(laneOf(bounce.normal, i));
        const uint32_t material = bounce.surface.material[i];
        const Vec3 sigma = lanes.sigma[i] =
            materials[material].radiusVaries
                ? materials.subsurfaceSigma(
                      material, materialPoint(tile.context, block.rays, bounce.surface, i))
                : materials[material].subsurfaceSigma;
        lanes.split[i] = splitSubsurface(bsdf, frame.toLocal(-directionOf(block.rays.ray, i)),
                                         walkingChannels(sigma, bounce.surface.offset[i]));
        if (!(lanes.split[i].probability > 0.0f))
        {
            bounce.subsurface &= ~(1u << i);
            continue;
        }
        bsdf = lanes.split[i].local;
        lanes.hidden |= static_cast<LaneMask>(isHidden(bsdf)) << i;
    }
    bounce.general &= ~lanes.hidden;
}

void walkBelowSurfaces(Tile& tile, PathBlock& block, Bounce& bounce, const SubsurfaceLanes& lanes,
                       PhotonUse use)
{
    bounce.general |= lanes.hidden;
    RayHitBlock leaving;
    leaving.ray = block.rays.ray;
    std::fill(std::begin(leaving.geometry.v), std::end(leaving.geometry.v), kInvalid);
    LaneMask left = 0, open = 0;
    for (const int i : lanesIn(bounce.subsurface))
    {
        const SubsurfaceSplit& split = lanes.split[i];
        const float p = split.probability;
        const Vec3 throughput = laneOf(block.throughput, i);
        if (!(numbersOf(tile, block, bounce.number, i, WalkChoice).x < p))
        {
            setLane(block.throughput, i, throughput / (1.0f - p));
            continue;
        }
        const Vec3 entering = throughput * split.entering / p;
        const SubsurfaceWalk walked = walk(tile, block, bounce, i, lanes, entering);
        tile.counts.secondaryRays += walked.rays;
        tile.counts.collisions += walked.collisions;
        if (walked.end == SubsurfaceWalk::End::Left)
        {
            setLane(block.throughput, i, walked.throughput);
            meetFromOutside(walked, leaving, i);
            left |= 1u << i;
            continue;
        }
        setLeaving(bounce, i, split.leaving, split.color);
        tile.counts.cutWalks += walked.end == SubsurfaceWalk::End::Cut;
        if (walked.end == SubsurfaceWalk::End::Open)
        {
            ++tile.counts.openWalks;
            setLane(block.throughput, i, entering);
            open |= 1u << i;
            continue;
        }
        bounce.diffuse &= ~(1u << i);
        bounce.general &= ~(1u << i);
    }
    if (left) leaveThere(tile, leaving, left, block, bounce);
    if (!(left | open)) return;
    Bounce below = bounce;
    below.below = true;
    below.diffuse &= left | open;
    below.general &= left | open;
    below.smooth = below.transmissive = below.subsurface = 0;
    addLightAt(tile, block, below, use);
    bounce.gathering |= below.gathering;
    bounce.rough |= below.rough;
    bounce.carried |= below.carried;
    bounce.terminating |= below.terminating;
}

void addLightAt(Tile& tile, PathBlock& block, Bounce& bounce, PhotonUse use)
{
    if (use != PhotonUse::None) chooseGathering(block, bounce, use);
    if (HitPoints* hits = tile.result.photons.hitPoints)
    {
        keepHitPoints(block, bounce, *hits);
        return;
    }
    if (use != PhotonUse::None) addPhotons(tile, block, bounce);
    sampleLights(tile, block, bounce);
}

} // namespace osgRayTrace::engine
