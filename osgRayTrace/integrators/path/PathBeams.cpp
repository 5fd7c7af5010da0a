// PathBeams.cpp - adds the light of photons within media to the rays of paths. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/path/PathMedium.h"
#include "osgRayTrace/integrators/shared/SegmentLights.h"
#include "osgRayTrace/photons/VolumePhotons.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the query of the stretches of some lanes.
BeamQuery queryOf(const PassContext& context, const MediumSegments& segments, LaneMask lanes,
                  int number)
{
    const MediumTable& media = context.traced->media();
    BeamQuery query;
    query.ray = segments.ray;
    query.lanes = lanes;
    query.mostEdges = static_cast<uint32_t>(context.options.maxBounces - number);
    query.radius = context.beamRadius;
    query.leastSine = context.leastSine;
    for (int i = 0; i < kLanes; ++i)
    {
        const bool used = (lanes >> i) & 1u;
        const MediumRecord& medium = media[used ? segments.media[i] : kOutside];
        query.begin[i] = used ? segments.parts[i].begin : 0.0f;
        query.end[i] = used ? segments.parts[i].end : 0.0f;
        setLane(query.sigmaT, i, medium.sigmaT);
        setLane(query.sigmaS, i, medium.sigmaS);
        const Phase& phase = medium.phase;
        query.anisotropy[i] = phase.g;
        query.draineG[i] = phase.draineG;
        query.draineAlpha[i] = phase.draineAlpha;
        query.draineShare[i] = phase.draineShare;
        query.hasDroplets |= phase.draineShare > 0.0f;
        if (used && medium.thins) query.thinning = &media;
        query.medium[i] = used ? segments.media[i] : kOutside;
    }
    return query;
}

/// Finds the beams that the camera rays of a tile may pass, once for all of its blocks.
const BeamPieces& tileBeams(Tile& tile, const BeamMap& map, float radius)
{
    if (tile.hasBeams) return tile.beams;
    const RayBlock* rays[kTileBlocks];
    LaneMask lanes[kTileBlocks];
    for (int b = 0; b < kTileBlocks; ++b)
    {
        rays[b] = &tile.paths.blocks[b].rays.ray;
        lanes[b] = kAllLanes;
    }
    map.find(bundleOf(rays, lanes, kTileBlocks), radius, tile.beams);
    tile.hasBeams = true;
    return tile.beams;
}

/// Returns the bundle that the stretch of a single ray is.
RayBundle bundleOf(const MediumSegments& segments, int i)
{
    const RayBlock& ray = *segments.ray;
    RayBundle bundle;
    bundle.origin = Vec3(ray.originX[i], ray.originY[i], ray.originZ[i]);
    bundle.axis = Vec3(ray.directionX[i], ray.directionY[i], ray.directionZ[i]);
    bundle.begin = segments.parts[i].begin;
    bundle.end = segments.parts[i].end;
    return bundle;
}

} // namespace

void addBeams(Tile& tile, const PathBlock& block, const MediumSegments& segments, LaneMask lanes,
              int number, bool fromCamera)
{
    const PassContext& context = tile.context;
    const BeamMap& map = context.volumePhotons->beams;
    if (!lanes || map.size() == 0) return;
    const BeamQuery query = queryOf(context, segments, lanes, number);
    Vec3Lanes radiance;
    const auto add = [&](int i)
    {
        const Vec3 sum = laneOf(block.throughput, i) * laneOf(radiance, i);
        tile.sums.add(block.flagsOf(i), sum);
        if (GatheredPhotons* gathered = tile.result.photons.gathered)
            gathered->carried += luminance(sum);
    };
    if (fromCamera)
    {
        const LaneMask all = kAllLanes;
        gatherBeams(tileBeams(tile, map, context.beamRadius), bundleOf(&segments.ray, &all, 1),
                    query, radiance);
        for (const int i : lanesIn(lanes))
            add(i);
        return;
    }
    for (const int i : lanesIn(lanes))
    {
        const RayBundle bundle = bundleOf(segments, i);
        map.find(bundle, context.beamRadius, tile.rayBeams);
        BeamQuery single = query;
        single.lanes = 1u << i;
        gatherBeams(tile.rayBeams, bundle, single, radiance);
        add(i);
    }
}

} // namespace osgRayTrace::engine
