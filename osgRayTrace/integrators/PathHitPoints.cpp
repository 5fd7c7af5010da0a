// PathHitPoints.cpp - hit points of camera paths: written when paths are followed, and gathered at.
// Layer: integrators. SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/HitShading.h"
#include "osgRayTrace/integrators/PathBounce.h"

namespace osgRayTrace::engine
{

namespace
{

constexpr bool bitOf(LaneMask lanes, int i)
{
    return (lanes >> i) & 1u;
}

constexpr LaneMask maskIf(bool condition, int i)
{
    return static_cast<LaneMask>(condition) << i;
}

/// The state in which a bounce stood at up to sixteen points of the same number of bounces.
void restore(const HitPoints& hits, const HitPoint* points, int count, PathBlock& block,
             Bounce& bounce)
{
    bounce.number = points[0].number;
    bounce.diffuse = bounce.general = bounce.through = bounce.gathering = bounce.ending = 0;
    SurfaceLanes& surface = bounce.surface;
    surface.lifted = 0;
    surface.hits = block.active = (1u << count) - 1u;
    for (int i = 0; i < kLanes; ++i)
    {
        // Lanes out of use hold the last point: vector code may read them.
        const HitPoint& point = points[i < count ? i : count - 1];
        setLane(surface.onTriangle, i, point.position);
        setLane(surface.position, i, point.start);
        setLane(surface.geometricNormal, i, point.geometricNormal);
        setLane(bounce.normal, i, point.normal);
        setLane(bounce.albedo, i, point.albedo);
        setLane(block.throughput, i, point.throughput);
        block.rays.ray.directionX[i] = point.direction.x;
        block.rays.ray.directionY[i] = point.direction.y;
        block.rays.ray.directionZ[i] = point.direction.z;
        surface.offset[i] = point.offset;
        surface.steep[i] = point.steep;
        surface.material[i] = point.material;
        surface.instance[i] = point.instance;
        block.seed[i] = point.seed;
        block.pixel[i] = point.pixel;
        if (i >= count) continue;
        if (!point.diffuse) bounce.bsdfs[i] = hits.bsdfs[point.bsdf];
        bounce.diffuse |= maskIf(point.diffuse, i);
        bounce.general |= maskIf(!point.diffuse, i);
        bounce.through |= maskIf(point.through, i);
        bounce.gathering |= maskIf(point.gathering, i);
        bounce.ending |= maskIf(point.ending, i);
        surface.lifted |= maskIf(point.lifted, i);
    }
}

} // namespace

void keepHitPoints(const PathBlock& block, const Bounce& bounce, HitPoints& hits)
{
    const SurfaceLanes& surface = bounce.surface;
    for (LaneMask lanes = bounce.diffuse | bounce.general; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        HitPoint point;
        point.position = laneOf(trianglePoints(surface), i);
        point.start = laneOf(surface.position, i);
        point.geometricNormal = laneOf(surface.geometricNormal, i);
        point.normal = laneOf(bounce.normal, i);
        point.direction = directionOf(block.rays.ray, i);
        point.throughput = laneOf(block.throughput, i);
        point.diffuse = bitOf(bounce.diffuse, i);
        point.albedo = point.diffuse ? laneOf(bounce.albedo, i) : Vec3(0.0f);
        point.offset = surface.offset[i];
        point.steep = surface.steep[i];
        point.material = surface.material[i];
        point.instance = surface.instance[i];
        point.seed = block.seed[i];
        point.pixel = block.pixel[i];
        point.bsdf = kInvalid;
        point.number = static_cast<uint16_t>(bounce.number);
        point.through = bitOf(bounce.through, i);
        point.lifted = bitOf(surface.lifted, i);
        point.gathering = bitOf(bounce.gathering, i);
        point.ending = bitOf(bounce.ending, i);
        if (!point.diffuse)
        {
            const Bsdf& bsdf = bounce.bsdfs[i];
            // Mirrors and smooth glass send nothing back from light samples or photons.
            if (bsdf.isSmooth() && bsdf.diffuse == Vec3(0.0f) && !point.gathering) continue;
            point.bsdf = static_cast<uint32_t>(hits.bsdfs.size());
            hits.bsdfs.push_back(bsdf);
        }
        hits.points.push_back(point);
    }
}

void gatherAtHitPoints(Tile& tile, const HitPoints& hits)
{
    PathBlock& block = tile.paths.blocks[0];
    Bounce bounce;
    bounce.bsdfs = tile.bsdfs;
    const std::size_t size = hits.points.size();
    for (std::size_t at = 0, end; at < size; at = end)
    {
        end = at + 1;
        while (end < size && end < at + kLanes && hits.points[end].number == hits.points[at].number)
            ++end;
        restore(hits, &hits.points[at], static_cast<int>(end - at), block, bounce);
        bounce.rough = bounce.gathering;
        addPhotons(tile, block, bounce);
        sampleLights(tile, block, bounce);
    }
}

} // namespace osgRayTrace::engine
