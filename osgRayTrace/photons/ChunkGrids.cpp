// ChunkGrids.cpp - takes photons through volumes, by null collisions. Layer: photons.
// SPDX-License-Identifier: MIT
//
// A photon is stored at all tentative collisions of its flight rather than at the real one: the sum
// of transmittance over the majorant is an estimate of the same integral, and does not divide by a
// density that may be next to nothing (GridRay.h). Some are added, so that thin media get points,
// too. Volumes end within the sphere of a look-up near their faces and where they are empty, but
// the light that the points stand for does not: points are therefore stored around volumes as well,
// as far as spheres reach. Look-ups multiply by what scatters at the point at which a path from the
// eye has collided.
//
// Points are for what a path from the eye finds within the boxes of volumes, and wherever the
// medium around is dense. For what it finds in a thin medium between the boxes there are beams. A
// beam is cut where volumes have taken from its light, by an estimate of their transmittance that
// is 1 at its origin; what the medium takes is left to the look-up. Beams go on into boxes, too, as
// far as kernels reach, so that no light is lost at a box in front of which a ray passes.
#include "osgRayTrace/photons/ChunkFlights.h"

#include "osgRayTrace/media/FreeFlight.h"
#include "osgRayTrace/photons/VolumePhotons.h"

#include <algorithm>

namespace osgRayTrace::engine
{

/// Returns the volumes on the stretch of a photon, and the medium around them. stores: the photon
/// leaves points there.
GridRay ChunkTracer::gridsOn(const PhotonPathBlock& block, const Flights& flights, int i,
                             bool stores) const
{
    const RayBlock& ray = _rays.ray;
    const float begin = flights.begin[i], end = flights.hasHit(i) ? ray.tFar[i] : kInfinity;
    GridRay grids(_inputs.traced.grids(), Vec3(ray.originX[i], ray.originY[i], ray.originZ[i]),
                  laneOf(block.direction, i), begin, end);
    grids.setAround(flights.media[flights.within[i]], flights.parts[i]);
    if (stores) grids.setReach(kWidestKernel * _inputs.emitter.scene().radius, {begin, end});
    return grids;
}

/// Stores a beam as parts, each with what volumes have left of its power.
void ChunkTracer::storeBetweenVolumes(const PhotonBeam& beam, uint32_t seed)
{
    const GridRay grids(_inputs.traced.grids(), beam.origin, beam.direction, 0.0f, beam.length);
    NumberStream numbers(seed);
    std::vector<EvenPart> parts;
    grids.evenParts({0.0f, beam.length}, kWidestKernel * _inputs.emitter.scene().radius, numbers,
                    parts);
    for (const EvenPart& even : parts)
    {
        PhotonBeam part = beam;
        part.begin = even.part.begin;
        part.length = even.part.end;
        part.power *= even.left;
        _chunk.beams.push_back(part);
    }
}

/// Takes a photon along a stretch of a scene with volumes.
ChunkTracer::FlightEnd ChunkTracer::flyGrids(PhotonPathBlock& block, Flights& flights, int i,
                                             const GridRay& grids)
{
    const Vec3 power = laneOf(block.power, i);
    if (!(largestOf(power) > 0.0f)) return FlightEnd::Dies; // it has underflowed
    NumberStream numbers(
        hash(flightSeed(flights.bounce, flights.stretch[i], FlightGrid), block.photon[i]));
    if (!(grids.scatters() || grids.isReached()) || mustArrive(flights))
    {
        const GridWay way = grids.way(numbers);
        _chunk.cutWalks += way.cut;
        setLane(block.power, i, power * way.left);
        return way.left == Vec3(0.0f) ? FlightEnd::Dies : meet(block, flights, i);
    }
    const bool thin = flights.isThin(i);
    if (thin) storeBeam(block, flights, i);
    flights.tentative.clear();
    const GridFlight flight = grids.flight(
        channelPmf(power), numbers, storesPoints(block, flights, i) ? &flights.tentative : nullptr);
    const RayBlock& ray = _rays.ray;
    const Vec3 origin(ray.originX[i], ray.originY[i], ray.originZ[i]);
    float count = 0.0f;
    const RayPart reached = grids.reached();
    for (const TentativeCollision& collision : flights.tentative)
    {
        // Beams have the light of a thin medium elsewhere.
        if (thin && !(collision.distance >= reached.begin && collision.distance <= reached.end))
            continue;
        const float kept = std::min(1.0f, kSurePoints / (count += 1.0f));
        if (kept < 1.0f && !(numbers.next() < kept)) continue;
        appendPoint(block, flights, i, origin + laneOf(block.direction, i) * collision.distance,
                    power * collision.weight / kept);
    }
    _chunk.cutWalks += flight.cut;
    if (flight.weight == Vec3(0.0f)) return FlightEnd::Dies;
    if (flight.collides) return scatterInGrids(block, flights, i, grids, flight, numbers);
    setLane(block.power, i, power * flight.weight);
    return meet(block, flights, i);
}

/// Scatters a photon at a point of its ray by what is there, unless roulette ends it.
ChunkTracer::FlightEnd ChunkTracer::scatterInGrids(PhotonPathBlock& block, Flights& flights, int i,
                                                   const GridRay& grids, const GridFlight& flight,
                                                   NumberStream& numbers)
{
    const Scatterers here = grids.scatterersAt(flight.distance);
    if (here.count == 0) return FlightEnd::Dies;
    const bool first = flights.bounce == 0 && !((_collided >> i) & 1u);
    const RayBlock& ray = _rays.ray;
    const Vec3 origin(ray.originX[i], ray.originY[i], ray.originZ[i]);
    const Vec3 direction = laneOf(block.direction, i);
    const Vec3 point = origin + direction * flight.distance;
    const Vec2 u = flightNumbers(block.photon[i], flights.bounce, flights.stretch[i], FlightPhase);
    const Vec3 after = here.sample(direction, numbers.next(), u.x, u.y);
    const float cosTheta = glm::dot(direction, after), pdf = here.pdf(cosTheta);
    if (!(pdf > 0.0f)) return FlightEnd::Dies;
    const Vec3 before = laneOf(block.power, i);
    const Vec3 power = before * flight.weight * here.scattered(cosTheta) / pdf;
    const float survival = std::min(1.0f, largestOf(power) / largestOf(before));
    countCollision(block, flights, i);
    if (!(numbers.next() < survival)) return FlightEnd::Dies;
    const float falloff = first ? fallenOff(block.light[i], point, flight.distance) : 1.0f;
    return leaveCollision(block, flights, i, point, after, power * (falloff / survival));
}

} // namespace osgRayTrace::engine
