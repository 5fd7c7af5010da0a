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
RayBundle bundleOf(const BeamQuery& query, int i)
{
    const RayBlock& ray = *query.ray;
    RayBundle bundle;
    bundle.origin = Vec3(ray.originX[i], ray.originY[i], ray.originZ[i]);
    bundle.axis = Vec3(ray.directionX[i], ray.directionY[i], ray.directionZ[i]);
    bundle.begin = query.begin[i];
    bundle.end = query.end[i];
    return bundle;
}

/// Adds up the beams on the stretches of a query, whose lanes' rays have these throughputs at the
/// stretches' begin.
class BeamGather
{
public:
    BeamGather(Tile& tile, const PathBlock& block, const MediumSegments& segments, bool fromCamera)
        : _tile(tile), _block(block), _segments(segments), _fromCamera(fromCamera)
    {
    }

    void add(const BeamQuery& query, const Vec3Lanes& throughput);

private:
    void addLane(int i, const Vec3Lanes& throughput)
    {
        const Vec3 sum = laneOf(throughput, i) * laneOf(_radiance, i);
        _tile.sums.add(_block.flagsOf(i), sum);
        if (GatheredPhotons* gathered = _tile.result.photons.gathered)
            gathered->carried += luminance(sum);
    }

    Tile& _tile;
    const PathBlock& _block;
    const MediumSegments& _segments;
    const bool _fromCamera;
    Vec3Lanes _radiance;
};

void BeamGather::add(const BeamQuery& query, const Vec3Lanes& throughput)
{
    const BeamMap& map = _tile.context.volumePhotons->beams;
    if (_fromCamera)
    {
        const LaneMask all = kAllLanes;
        gatherBeams(tileBeams(_tile, map, query.radius), bundleOf(&_segments.ray, &all, 1), query,
                    _radiance);
        for (const int i : lanesIn(query.lanes))
            addLane(i, throughput);
        return;
    }
    for (const int i : lanesIn(query.lanes))
    {
        const RayBundle bundle = bundleOf(query, i);
        map.find(bundle, query.radius, _tile.rayBeams);
        BeamQuery single = query;
        single.lanes = 1u << i;
        gatherBeams(_tile.rayBeams, bundle, single, _radiance);
        addLane(i, throughput);
    }
}

/// Adds up the beams between volumes, part by part of each ray. What the volumes leave of the
/// light between a part and the one before is estimated.
void addBetweenVolumes(BeamGather& gather, const PathBlock& block, const MediumSegments& segments,
                       BeamQuery& query)
{
    Vec3Lanes throughput = block.throughput;
    FloatLanes begin, behind; // of the last part
    for (const int i : lanesIn(query.lanes))
        begin[i] = behind[i] = segments.parts[i].begin;
    for (uint32_t number = 0; query.lanes; ++number)
    {
        for (const int i : lanesIn(query.lanes))
        {
            const GridRay* grids = segments.gridsOf(i);
            RayPart part;
            if (grids)
                part = grids->partBetween(behind[i]);
            else if (number == 0)
                part = segments.parts[i];
            Vec3 left(1.0f);
            if (grids && !part.isEmpty())
            {
                NumberStream numbers(segments.numbers[i].seedOf(MediumGridBeams + number));
                left = grids->transmittance(begin[i], part.begin, numbers);
            }
            if (part.isEmpty() || left == Vec3(0.0f))
            {
                query.lanes &= ~(1u << i);
                continue;
            }
            setLane(throughput, i, laneOf(throughput, i) * left);
            query.begin[i] = begin[i] = part.begin;
            query.end[i] = behind[i] = part.end;
        }
        if (query.lanes) gather.add(query, throughput);
    }
}

} // namespace

void addBeams(Tile& tile, const PathBlock& block, const MediumSegments& segments, LaneMask lanes,
              int number, bool fromCamera)
{
    const PassContext& context = tile.context;
    if (!lanes || context.volumePhotons->beams.size() == 0) return;
    BeamQuery query = queryOf(context, segments, lanes, number);
    BeamGather gather(tile, block, segments, fromCamera);
    if (segments.grids)
        addBetweenVolumes(gather, block, segments, query);
    else
        gather.add(query, block.throughput);
}

} // namespace osgRayTrace::engine
