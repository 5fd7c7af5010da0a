// PathVolumes.cpp - takes paths through volumes, by null collisions. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/path/PathMediumWalk.h"

#include "osgRayTrace/media/FreeFlight.h"

namespace osgRayTrace::engine
{

/// Finds the volumes on the stretch of lane i.
void MediumWalk::findGrids(int i, Vec3 origin, float end)
{
    std::optional<GridRay>& grids = (*_grids)[i];
    grids.emplace(_traced.grids(), origin, directionOf(_block.rays.ray, i), _begin[i], end);
    if (grids->isEmpty())
    {
        grids.reset();
        return;
    }
    if (_light) grids->setLight(*_light);
    grids->setAround(_media[_segments.media[i]], _segments.parts[i]);
    _segments.parts[i] = grids->extent();
    if (grids->scatters() && !_last) _segments.lanes |= 1u << i;
}

/// Takes a path along a stretch with volumes on it.
MediumWalk::End MediumWalk::travelGrids(int i, const GridRay& grids)
{
    NumberStream numbers(_segments.numbers[i].seedOf(MediumFlight));
    const Vec3 throughput = laneOf(_block.throughput, i);
    const PathFlags flags = _block.flagsOf(i);
    if (!grids.scatters() || !_collides)
    {
        const GridWay way = grids.way(numbers);
        _tile.counts.cutWalks += way.cut;
        _tile.sums.add(flags, throughput * way.emitted);
        setLane(_block.throughput, i, throughput * way.left);
        return way.left == Vec3(0.0f) ? End::Dies : meet(i);
    }
    const GridFlight flight = grids.flight(channelPmf(throughput), numbers);
    _tile.counts.cutWalks += flight.cut;
    _tile.sums.add(flags, throughput * flight.emitted);
    if (flight.weight == Vec3(0.0f)) return End::Dies;
    setLane(_block.throughput, i, throughput * flight.weight);
    return flight.collides ? scatterInGrids(i, grids, flight.distance) : meet(i);
}

/// Scatters a path at a point of its ray by what is there, unless roulette ends it.
MediumWalk::End MediumWalk::scatterInGrids(int i, const GridRay& grids, float distance)
{
    const Scatterers here = grids.scatterersAt(distance);
    if (here.count == 0) return End::Dies;
    const MediumNumbers& numbers = _segments.numbers[i];
    const RayBlock& ray = _block.rays.ray;
    const Vec3 before = directionOf(ray, i);
    const Vec3 point = Vec3(ray.originX[i], ray.originY[i], ray.originZ[i]) + before * distance;
    if (_media[_segments.media[i]].isDense || grids.isWithin(distance)) // else there are beams
        addPhotonPoints(i, distance, laneOf(_block.throughput, i), &here);
    const Vec2 u = numbers.at(MediumPhase);
    const Vec3 after = here.sample(before, numbers.at(MediumBoundary).x, u.x, u.y);
    const float cosTheta = glm::dot(before, after), pdf = here.pdf(cosTheta);
    if (!(pdf > 0.0f)) return End::Dies;
    if (!survives(i, laneOf(_block.throughput, i) * here.scattered(cosTheta) / pdf))
        return End::Dies;
    _block.pdfW[i] = pdf;
    _block.flags[i] = flagsAfterCollision(i).word();
    spawn(i, {point, 0.0f}, after);
    return End::GoesOn;
}

} // namespace osgRayTrace::engine
