// PathHitPoints.cpp - keeps hit points of camera paths and gathers at them. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/HitShading.h"

namespace osgRayTrace::engine
{

namespace
{

/// Returns a mask with bit to if bit from of the mask is set.
constexpr LaneMask moved(LaneMask mask, int from, int to)
{
    return ((mask >> from) & 1u) << to;
}

/// Sets block and bounce to the state in which the bounce stood at the points.
void restore(const HitPoints& hits, const HitPointBlock& points, PathBlock& block, Bounce& bounce)
{
    const LaneMask all = (1u << points.count) - 1u;
    bounce.number = points.number;
    bounce.normal = points.normal;
    bounce.albedo = points.albedo;
    bounce.diffuse = points.diffuse;
    bounce.general = all & ~points.diffuse;
    bounce.transmissive = points.transmissive;
    bounce.gathering = points.gathering;
    bounce.terminating = points.terminating;
    SurfaceLanes& surface = bounce.surface;
    surface.onTriangle = points.position;
    surface.position = points.start;
    surface.geometricNormal = points.geometricNormal;
    surface.offset = points.offset;
    surface.minCosine = points.minCosine;
    surface.material = points.material;
    surface.instance = points.instance;
    surface.terminatorLanes = points.terminatorLanes;
    surface.hits = block.active = all;
    block.throughput = points.throughput;
    block.rays.ray.directionX = points.direction.x;
    block.rays.ray.directionY = points.direction.y;
    block.rays.ray.directionZ = points.direction.z;
    block.seed = points.seed;
    block.flags = points.flags;
    for (const int i : lanesIn(bounce.general))
        bounce.bsdfs[i] = hits.bsdfs[points.bsdf[i]];
}

/// Returns a block of hits that has room for a point of the bounce with this number.
HitPointBlock& blockFor(int number, HitPoints& hits)
{
    if (hits.blocks.empty() || hits.blocks.back().number != number ||
        hits.blocks.back().count == kLanes)
    {
        hits.blocks.emplace_back();
        hits.blocks.back().number = number;
    }
    return hits.blocks.back();
}

/// Copies lane i of a bounce to lane to of the points.
void keepLane(HitPointBlock& points, int to, const PathBlock& block, const Bounce& bounce, int i,
              uint32_t bsdf)
{
    const SurfaceLanes& surface = bounce.surface;
    setLane(points.position, to, laneOf(trianglePoints(surface), i));
    setLane(points.start, to, laneOf(surface.position, i));
    setLane(points.geometricNormal, to, laneOf(surface.geometricNormal, i));
    setLane(points.normal, to, laneOf(bounce.normal, i));
    setLane(points.direction, to, directionOf(block.rays.ray, i));
    setLane(points.throughput, to, laneOf(block.throughput, i));
    const bool diffuse = (bounce.diffuse >> i) & 1u;
    setLane(points.albedo, to, diffuse ? laneOf(bounce.albedo, i) : Vec3(0.0f));
    points.offset[to] = surface.offset[i];
    points.minCosine[to] = surface.minCosine[i];
    points.material[to] = surface.material[i];
    points.instance[to] = surface.instance[i];
    points.seed[to] = block.seed[i];
    points.flags[to] = block.flags[i];
    points.bsdf[to] = bsdf;
}

} // namespace

void keepHitPoints(const PathBlock& block, const Bounce& bounce, HitPoints& hits)
{
    for (const int i : lanesIn(bounce.diffuse | bounce.general))
    {
        uint32_t kept = kInvalid;
        if (!((bounce.diffuse >> i) & 1u))
        {
            const Bsdf& bsdf = bounce.bsdfs[i];
            const bool gathering = (bounce.gathering >> i) & 1u;
            // Mirrors and smooth glass send nothing back from light samples or photons.
            if (bsdf.isMirror() && !gathering) continue;
            kept = static_cast<uint32_t>(hits.bsdfs.size());
            hits.bsdfs.push_back(bsdf);
        }
        HitPointBlock& points = blockFor(bounce.number, hits);
        const int at = points.count++;
        // Vector code reads unused lanes as well: the first point of a block fills all lanes.
        for (int to = at; to < (at == 0 ? kLanes : at + 1); ++to)
            keepLane(points, to, block, bounce, i, kept);
        points.diffuse |= moved(bounce.diffuse, i, at);
        points.transmissive |= moved(bounce.transmissive, i, at);
        points.terminatorLanes |= moved(bounce.surface.terminatorLanes, i, at);
        points.gathering |= moved(bounce.gathering, i, at);
        points.terminating |= moved(bounce.terminating, i, at);
    }
}

void gatherAtHitPoints(Tile& tile, const HitPoints& hits)
{
    PathBlock& block = tile.paths.blocks[0];
    Bounce bounce;
    bounce.bsdfs = tile.bsdfs;
    for (const HitPointBlock& points : hits.blocks)
    {
        restore(hits, points, block, bounce);
        bounce.rough = bounce.gathering;
        addPhotons(tile, block, bounce);
        sampleLights(tile, block, bounce);
    }
}

} // namespace osgRayTrace::engine
