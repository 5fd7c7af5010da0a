// PathScatter.cpp - sends paths on from surfaces, or ends them. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/SkyPortals.h"
#include "osgRayTrace/shading/SmoothLanes.h"

#include <algorithm>
#include <cstdlib>

namespace osgRayTrace::engine
{

namespace
{

/// NextRays holds the next ray of each lane.
struct NextRays
{
    Vec3Lanes wi, origin;
    FloatLanes tNear, pdfW;
    Vec3Lanes weight; ///< factor of the next ray's throughput
};

/// Sets lane i of diffuseDirections. Returns all bits if light comes from the direction, else none.
OSGRAYTRACE_INLINE uint32_t diffuseDirection(const Vec3Lanes& normals, const SurfaceLanes& surface,
                                             int i, float u, float v, NextRays& next)
{
    const PlainVec3 local = squareToCosineHemispherePlain(u, v);
    const PlainVec3 wi = toWorld(frameOf(plainOf(normals, i)), local);
    setLane(next.wi, i, wi);
    next.pdfW[i] = local.z * kInvPi;
    const PlainVec3 facet = plainOf(surface.geometricNormal, i);
    const float above = dot(wi, facet);
    const bool steep = above > surface.minCosine[i];
    const float offset = select(steep, 0.0f, surface.offset[i]);
    setLane(next.origin, i, mad(facet, offset, plainOf(surface.position, i)));
    next.tNear[i] = select(steep, surface.offset[i] / std::max(above, surface.minCosine[i]), 0.0f);
    const uint32_t leaves = maskOf(above > 0.0f) | laneBit(surface.terminatorLanes, i);
    return leaves & maskOf(local.z > 0.0f);
}

/// Sets the next rays of diffuse lanes, with pdfW = cos/pi. Returns the lanes where isAbove holds.
OSGRAYTRACE_KERNEL
LaneMask diffuseDirections(const Vec3Lanes& normal, const SurfaceLanes& surface,
                           const FloatLanes& u, const FloatLanes& v, NextRays& next)
{
    LaneMask alive = 0;
    OSGRAYTRACE_SIMD_OR(alive)
    for (int i = 0; i < kLanes; ++i)
        alive |= bitOfLane(diffuseDirection(normal, surface, i, u[i], v[i], next), i);
    return alive;
}

/// The reflections of camera paths that split at a clear interface.
struct SplitRays
{
    LaneMask lanes = 0;
    NextRays next;       ///< weight: throughput
    FloatLanes etaScale; ///< as it was before the interface
};

/// Returns the lanes whose paths have met nothing but mirrors and clear interfaces, among which
/// this is the first one that both reflects and transmits. Hit points that are kept, and photons
/// of the local schedule, are counted pixel by pixel for one path each.
LaneMask splittingLanes(const Tile& tile, const PathBlock& block, const Bounce& bounce)
{
    const GatheredPhotons* gathered = tile.result.photons.gathered;
    LaneMask lanes = 0;
    if (tile.result.photons.hitPoints || (gathered && gathered->separate)) return lanes;
    for (const int i : lanesIn(bounce.smooth & bounce.transmissive & block.active))
    {
        const PathFlags path = block.flagsOf(i);
        lanes |= static_cast<LaneMask>(!path.isScattered() && !path.isSplit()) << i;
    }
    return lanes;
}

/// Sets the reflections of lanes that split, as far as there is room for them, and makes the lanes
/// themselves refract, with the shares of the light that either lobe takes:
///
///   L = w_reflected L_reflected + w_refracted L_refracted
///
/// A lamp that a clear surface mirrors would be found by chance with a probability of some 4 %,
/// and then be 25 times as bright.
void splitRays(const Tile& tile, PathBlock& block, const Bounce& bounce,
               const InterfaceLanes& interfaces, const IncidentLanes& incident, SplitRays& split,
               FloatLanes& lobe)
{
    FloatLanes first;
    for (int i = 0; i < kLanes; ++i)
        first[i] = 0.0f;
    const SmoothLanes sampled =
        sampleSmoothLanes(interfaces, incident, first, split.lanes, Transport::Radiance,
                          split.next.wi, split.next.weight);
    int room = PathQueue::kBlocks * kLanes - tile.paths.count * kLanes - tile.paths.added;
    LaneMask lanes = 0;
    for (const int i : lanesIn(split.lanes & sampled.alive & ~sampled.transmitted))
    {
        const float p = sampled.reflects[i];
        const Vec3 direction = laneOf(split.next.wi, i);
        if (!(p > 0.0f && p < 1.0f) || room == 0) continue;
        if (!isAboveFacet(bounce.surface, i, direction)) continue;
        const RayBegin begin = leaveFacet(bounce.surface, i, direction);
        setLane(split.next.origin, i, begin.origin);
        split.next.tNear[i] = begin.tNear;
        setLane(split.next.weight, i,
                laneOf(block.throughput, i) * laneOf(split.next.weight, i) * p);
        split.etaScale[i] = block.etaScale[i];
        setLane(block.throughput, i, laneOf(block.throughput, i) * (1.0f - p));
        block.flags[i] = block.flagsOf(i).split().word();
        lobe[i] = kOneMinusEpsilon;
        lanes |= 1u << i;
        --room;
    }
    split.lanes = lanes;
}

/// Adds the paths of the reflections to the tile's.
void addSplitPaths(Tile& tile, const PathBlock& block, const UintLanes& flags,
                   const SplitRays& split)
{
    constexpr uint32_t kReflected = 0x51e7u; // makes the seeds those of other paths
    const bool vertices = tile.context.traced->lights().tree() != nullptr;
    for (const int i : lanesIn(split.lanes))
    {
        const auto [to, k] = addPath(tile.paths, block, i, vertices);
        const Vec3 origin = laneOf(split.next.origin, i), direction = laneOf(split.next.wi, i);
        RayBlock& ray = to.rays.ray;
        ray.originX[k] = origin.x;
        ray.originY[k] = origin.y;
        ray.originZ[k] = origin.z;
        ray.directionX[k] = direction.x;
        ray.directionY[k] = direction.y;
        ray.directionZ[k] = direction.z;
        ray.tNear[k] = split.next.tNear[i];
        setLane(to.throughput, k, laneOf(split.next.weight, i));
        to.pdfW[k] = kInfinity;
        to.etaScale[k] = split.etaScale[i];
        to.seed[k] = hash(block.seed[i] + kReflected);
        to.flags[k] = PathFlags::afterSurface(flags[i], 0u, 0u, 0u, ~0u);
    }
}

/// Sets the next rays of the lanes at smooth interfaces. Returns the lanes that go on.
LaneMask mirror(Tile& tile, PathBlock& block, const Bounce& bounce, FloatLanes& lobe,
                NextRays& next, SplitRays& split)
{
    if (!bounce.smooth) return 0;
    InterfaceLanes interfaces;
    for (const int i : lanesIn(bounce.smooth))
        interfaces.set(i, bounce.bsdfs[i]);
    const RayBlock& ray = block.rays.ray;
    const IncidentLanes incident{ray.directionX, ray.directionY, ray.directionZ, bounce.normal};
    split.lanes = splittingLanes(tile, block, bounce);
    if (split.lanes) splitRays(tile, block, bounce, interfaces, incident, split, lobe);
    const SmoothLanes sampled = sampleSmoothLanes(interfaces, incident, lobe, bounce.smooth,
                                                  Transport::Radiance, next.wi, next.weight);
    LaneMask alive = 0;
    for (const int i : lanesIn(sampled.alive))
    {
        const bool transmitted = (sampled.transmitted >> i) & 1u;
        const Vec3 direction = laneOf(next.wi, i);
        if (isAboveFacet(bounce.surface, i, direction) == transmitted) continue;
        const RayBegin begin = leaveFacet(bounce.surface, i, direction);
        setLane(next.origin, i, begin.origin);
        next.tNear[i] = begin.tNear;
        next.pdfW[i] = kInfinity;
        if (transmitted)
        {
            const float eta = bounce.bsdfs[i].transmittedEta();
            block.etaScale[i] *= eta * eta;
        }
        alive |= 1u << i;
    }
    return alive;
}

/// Random numbers that choose a lobe and a direction in it.
struct BsdfNumbers
{
    const FloatLanes &lobe, &u, &v;
};

/// Sets the next rays of general lanes that are not smooth. Returns the lanes that go on.
LaneMask scatterGeneral(PathBlock& block, const Bounce& bounce, const BsdfNumbers& numbers,
                        NextRays& next)
{
    LaneMask alive = 0;
    for (const int i : lanesIn(bounce.general & ~bounce.smooth))
    {
        const ShadingFrame frame(laneOf(bounce.normal, i));
        const Vec3 wo = frame.toLocal(-directionOf(block.rays.ray, i));
        const std::optional<BsdfSample> sample =
            sampleBsdf(bounce.bsdfs[i], wo, numbers.lobe[i], numbers.u[i], numbers.v[i]);
        if (!sample || (!sample->delta && ((bounce.terminating >> i) & 1u))) continue;
        const Vec3 direction = frame.toWorld(sample->wi);
        const SurfaceLanes& surface = bounce.surface;
        const bool above =
            sample->delta ? isAboveFacet(surface, i, direction) : isAbove(surface, i, direction);
        if (above == sample->transmitted) continue;
        setLane(next.wi, i, direction);
        const RayBegin begin =
            sample->delta ? leaveFacet(surface, i, direction) : leave(surface, i, direction);
        setLane(next.origin, i, begin.origin);
        next.tNear[i] = begin.tNear;
        setLane(next.weight, i, sample->weight);
        next.pdfW[i] = sample->delta ? kInfinity : sample->pdfW;
        if (sample->transmitted)
        {
            const float eta = bounce.bsdfs[i].transmittedEta();
            block.etaScale[i] *= eta * eta;
        }
        alive |= 1u << i;
    }
    return alive;
}

/// Sets the next rays' throughput and the survival of roulette. Returns lanes that have throughput.
OSGRAYTRACE_KERNEL
LaneMask weigh(const PathBlock& block, const Vec3Lanes& weight, Vec3Lanes& throughput,
               FloatLanes& survival)
{
    LaneMask positive = 0;
    OSGRAYTRACE_SIMD_OR(positive)
    for (int i = 0; i < kLanes; ++i)
    {
        const float x = block.throughput.x[i] * weight.x[i];
        const float y = block.throughput.y[i] * weight.y[i];
        const float z = block.throughput.z[i] * weight.z[i];
        const float xy = select(x > y, x, y);
        const float largest = select(xy > z, xy, z);
        const float wanted = largest * block.etaScale[i] * (1.0f / kRouletteThroughput);
        throughput.x[i] = x;
        throughput.y[i] = y;
        throughput.z[i] = z;
        survival[i] = select(wanted < 1.0f, wanted, 1.0f);
        positive |= bitOfLane(maskOf(largest > 0.0f), i);
    }
    return positive;
}

/// Returns the lanes that roulette may end.
OSGRAYTRACE_KERNEL
LaneMask lanesBelowOne(const FloatLanes& survival)
{
    LaneMask below = 0;
    OSGRAYTRACE_SIMD_OR(below)
    for (int i = 0; i < kLanes; ++i)
        below |= bitOfLane(maskOf(survival[i] < 1.0f), i);
    return below;
}

/// Divides the throughput by the probability of survival. Returns the lanes that go on.
OSGRAYTRACE_KERNEL
LaneMask playRoulette(const FloatLanes& roulette, const FloatLanes& survival, Vec3Lanes& throughput)
{
    LaneMask survivors = 0;
    OSGRAYTRACE_SIMD_OR(survivors)
    for (int i = 0; i < kLanes; ++i)
    {
        const float q = survival[i];
        throughput.x[i] /= q;
        throughput.y[i] /= q;
        throughput.z[i] /= q;
        survivors |= bitOfLane(maskOf(roulette[i] < q), i);
    }
    return survivors;
}

/// Sets the rays of all lanes, whether they go on or not.
OSGRAYTRACE_KERNEL
void spawnRays(PathBlock& block, const NextRays& next, const Vec3Lanes& throughput,
               LaneMask gathering, LaneMask rough, LaneMask carried)
{
    const Vec3Lanes &origin = next.origin, &wi = next.wi;
    const FloatLanes &tNear = next.tNear, &pdfW = next.pdfW;
    RayBlock& ray = block.rays.ray;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        ray.originX[i] = origin.x[i];
        ray.originY[i] = origin.y[i];
        ray.originZ[i] = origin.z[i];
        ray.tNear[i] = tNear[i];
        ray.directionX[i] = wi.x[i];
        ray.directionY[i] = wi.y[i];
        ray.directionZ[i] = wi.z[i];
        block.throughput.x[i] = throughput.x[i];
        block.throughput.y[i] = throughput.y[i];
        block.throughput.z[i] = throughput.z[i];
        block.pdfW[i] = pdfW[i];
        block.flags[i] =
            PathFlags::afterSurface(block.flags[i], laneBit(gathering, i), laneBit(rough, i),
                                    laneBit(carried, i), maskOf(!(pdfW[i] < kInfinity)));
    }
}

} // namespace

void scatter(Tile& tile, PathBlock& block, const Bounce& bounce)
{
    FloatLanes u, v, lobe, roulette;
    const uint32_t pass = tile.context.pathKey.index;
    const auto lobeAndRoulette = [&]
    {
        dimensionPoints(block.seed, pass, bounceDimension(bounce.number, DimensionBsdfLobe), lobe,
                        roulette);
    };
    dimensionPoints(block.seed, pass, bounceDimension(bounce.number, DimensionBsdfDirection), u, v);
    if (bounce.general) lobeAndRoulette();

    NextRays next;
    next.weight = bounce.albedo;
    LaneMask alive = diffuseDirections(bounce.normal, bounce.surface, u, v, next) & bounce.diffuse &
                     ~bounce.terminating;
    SplitRays split;
    alive |= mirror(tile, block, bounce, lobe, next, split);
    alive |= scatterGeneral(block, bounce, {lobe, u, v}, next);

    Vec3Lanes throughput;
    FloatLanes survival;
    block.active = weigh(block, next.weight, throughput, survival) & alive;
    if (bounce.number + 1 >= kRouletteBounce && (lanesBelowOne(survival) & block.active))
    {
        if (!bounce.general) lobeAndRoulette();
        block.active &= playRoulette(roulette, survival, throughput);
    }
    const UintLanes flags = block.flags;
    const bool panes = tile.context.portals && !tile.context.portals->panes().empty();
    const PaneMarks marks = panes ? paneMarks(tile, block, bounce) : PaneMarks();
    spawnRays(block, next, throughput, bounce.gathering, bounce.rough, bounce.carried);
    if (panes) markPanes(marks, block);
    if (tile.context.traced->traits().mipmaps)
    {
        LaneMask mirrored = split.lanes;
        for (const int i : lanesIn(block.active))
            mirrored |= static_cast<LaneMask>(!(next.pdfW[i] < kInfinity)) << i;
        moveCones(block.rays.ray, mirrored, block.cones);
    }
    if (split.lanes) addSplitPaths(tile, block, flags, split);
}

} // namespace osgRayTrace::engine
