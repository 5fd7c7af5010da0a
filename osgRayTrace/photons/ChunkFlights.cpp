// ChunkFlights.cpp - takes photons through participating media to the next surface. Layer: photons.
// SPDX-License-Identifier: MIT
//
// A photon flies as a path from the eye does (PathMedium.cpp), with its power in place of the
// throughput:
//
//   power' = power sigmaS T(t) / pdf(t) / survival     at a collision
//   power' = power T(d) / probability                  if it comes to a surface
//
// The first of a pass's photons leave beams: of all their ways through media that scatter, each
// with the power at the begin of the way. Transmittance along a beam is part of the look-up, so a
// beam goes on to the next surface wherever its photon has collided (long beams [Jarosz11]). What
// comes straight from lights leaves none, as look-ups sample that light (SegmentLights.h). Of
// long walks later beams are kept by chance: 4 / k of the k-th.
//
// Edges count as those of paths from the eye do. All collisions between two surfaces belong to one
// edge, and so does what happens at the inner side of a smooth body that scatters, which for
// photons is where they come in. Collisions add an edge between the light and the first surface,
// and a second one if there are more than one there; or else one between the first two surfaces.
// Paths from the eye need that many, as PathMedium.cpp scatters them only where light could follow.
//
// Volumes have no closed form of transmittance, which beams would need at every look-up: photons
// are points within their boxes, and beams between them. In scenes with volumes only those photons
// are stored within media that paths cannot find well: which have met mirror-like surfaces and
// nothing else since they left their light. ChunkGrids.cpp has the flights through volumes.
#include "osgRayTrace/photons/ChunkFlights.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/NormalMaps.h"
#include "osgRayTrace/media/FreeFlight.h"
#include "osgRayTrace/media/PhaseFunction.h"
#include "osgRayTrace/media/Transmittance.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Beams end where so little of their light is left.
constexpr float kBeamEnd = 9.21f; ///< optical depth: exp(-9.21) = 1e-4

/// Of the ways of a photon between two surfaces so many leave a beam each; later ones by chance.
constexpr float kSureBeams = 4.0f;

/// Returns the edges of a path from the light to a collision on the way on which a photon is, which
/// has met so many surfaces.
uint32_t edgesInMedium(int32_t met, uint32_t late)
{
    if (met == 0) return 2;
    const uint32_t added = met == 1 ? std::max(late, 1u) : late;
    return std::max(2u, static_cast<uint32_t>(met) + added);
}

} // namespace

/// Returns the seed of the numbers of a stretch that have the same use.
uint32_t ChunkTracer::flightSeed(int bounce, uint32_t stretch, uint32_t use) const
{
    constexpr uint32_t kFlight = 0x666c7974u; // tells these dimensions from all others
    return dimension(hash(kFlight + static_cast<uint32_t>(bounce), 4 * stretch + use));
}

/// Returns two numbers of a stretch. The first stretch of each edge takes points of Sobol's
/// sequence over the photons; the walk that may follow takes independent numbers.
Vec2 ChunkTracer::flightNumbers(uint32_t photon, int bounce, uint32_t stretch, uint32_t use) const
{
    const uint32_t seed = flightSeed(bounce, stretch, use);
    Vec2 point;
    if (stretch == 0)
    {
        sobol2(photon, seed, point.x, point.y);
        return point;
    }
    const uint32_t key = hash(seed, photon);
    return {unitFloat(key), unitFloat(hash(key + 0x9e3779b9u))};
}

/// Stores the way of a photon through a medium as a beam.
void ChunkTracer::storeBeam(const PhotonPathBlock& block, const Flights& flights, int i)
{
    const uint32_t photon = block.photon[i], step = flights.steps[i];
    const uint32_t beams = std::min(_inputs.options.beams, _inputs.options.photons);
    const uint32_t edges = edgesInMedium(block.met[i], block.late[i]);
    const MediumRecord& medium = flights.media[flights.within[i]];
    const bool isDirect = flights.bounce == 0 && step == 0;
    if (isDirect || photon >= beams || medium.isDense) return;
    const bool volumes = _inputs.traits.volumes;
    if (volumes && block.direct[i] == 0) return;
    if (edges > static_cast<uint32_t>(_inputs.options.maxBounces)) return;
    const float kept = std::min(1.0f, kSureBeams / static_cast<float>(step + 1));
    const Vec2 numbers = flightNumbers(photon, flights.bounce, flights.stretch[i], FlightKept);
    if (kept < 1.0f && !(numbers.x < kept)) return;
    const RayPart& part = flights.parts[i];
    const RayBlock& ray = _rays.ray;
    PhotonBeam beam;
    beam.direction = laneOf(block.direction, i);
    beam.origin =
        Vec3(ray.originX[i], ray.originY[i], ray.originZ[i]) + beam.direction * part.begin;
    const float sigma = std::min(medium.sigmaT.x, std::min(medium.sigmaT.y, medium.sigmaT.z));
    const MediumWay way = flights.wayOf(ray, beam.direction, i);
    const float most = sigma > 0.0f ? kBeamEnd / sigma : kInfinity;
    beam.length = most < way.length() ? way.distanceAt(most) - part.begin : part.end - part.begin;
    const float scale =
        static_cast<float>(_inputs.options.photons) / (static_cast<float>(beams) * kept);
    beam.power = laneOf(block.power, i) * scale;
    beam.medium = flights.within[i];
    beam.edges = edges;
    if (!isFinite(beam.power) || !isFinite(beam.origin) || !(beam.length < kInfinity))
        ++_chunk.dropped;
    else if (volumes)
        storeBetweenVolumes(
            beam, hash(flightSeed(flights.bounce, flights.stretch[i], FlightGrid), ~photon));
    else if (beam.length > 0.0f)
        _chunk.beams.push_back(beam);
}

/// Returns whether a photon is stored where it collides: with dense media, unless it comes straight
/// from its light; in scenes with volumes, if it has met mirror-like surfaces and nothing else.
bool ChunkTracer::storesPoints(const PhotonPathBlock& block, const Flights& flights, int i) const
{
    if (_inputs.traits.volumes) return flights.bounce > 0 && block.direct[i] != 0;
    return flights.media[flights.within[i]].isDense &&
           (flights.bounce > 0 || ((_collided >> i) & 1u) != 0);
}

/// Stores a photon at a collision with a homogeneous medium.
void ChunkTracer::storePoint(const PhotonPathBlock& block, const Flights& flights, int i, Vec3 at,
                             Vec3 power)
{
    const float kept = std::min(1.0f, kSurePoints / static_cast<float>(flights.steps[i] + 1));
    const Vec2 numbers =
        flightNumbers(block.photon[i], flights.bounce, flights.stretch[i], FlightKept);
    if (kept < 1.0f && !(numbers.y < kept)) return;
    appendPoint(block, flights, i, at, power / kept);
}

/// Stores a photon at a point of its ray.
void ChunkTracer::appendPoint(const PhotonPathBlock& block, const Flights& flights, int i, Vec3 at,
                              Vec3 power)
{
    const uint32_t edges = edgesInMedium(block.met[i], block.late[i]);
    if (edges > static_cast<uint32_t>(_inputs.options.maxBounces)) return;
    const PhotonPoint point{at, laneOf(block.direction, i), power, flights.within[i], edges};
    if (isFinite(point.power) && isFinite(at))
        _chunk.points.push_back(point);
    else
        ++_chunk.dropped;
}

/// Returns whether photons may not collide: caustics begin with a surface, and what collides before
/// it is left to paths.
bool ChunkTracer::mustArrive(const Flights& flights) const
{
    return flights.bounce == 0 && _inputs.options.use == PhotonUse::Caustics;
}

/// Takes a photon along its stretch.
ChunkTracer::FlightEnd ChunkTracer::fly(PhotonPathBlock& block, Flights& flights, int i)
{
    if (_inputs.traits.volumes)
    {
        const bool stores = storesPoints(block, flights, i);
        const GridRay grids = gridsOn(block, flights, i, stores);
        const bool leavesPoints =
            stores && (grids.isReached() || (!flights.isThin(i) && grids.scatters()));
        if (!grids.isEmpty() || leavesPoints) return flyGrids(block, flights, i, grids);
    }
    const RayPart& part = flights.parts[i];
    if (part.isEmpty()) return meet(block, flights, i);
    const MediumRecord& medium = flights.media[flights.within[i]];
    const MediumWay way = flights.wayOf(_rays.ray, laneOf(block.direction, i), i);
    const float length = way.length();
    const Vec3 power = laneOf(block.power, i);
    if (!(largestOf(power) > 0.0f)) return FlightEnd::Dies; // it has underflowed
    if (!medium.scatters || mustArrive(flights))
    {
        setLane(block.power, i, power * transmittance(medium.sigmaT, length));
        return meet(block, flights, i);
    }
    storeBeam(block, flights, i);
    const float u =
        flightNumbers(block.photon[i], flights.bounce, flights.stretch[i], FlightLength).x;
    const FreeFlight flight = sampleFlight(medium.sigmaT, length, channelPmf(power), u);
    setLane(block.power, i, power * flight.weight);
    if (!flight.collides) return meet(block, flights, i);
    return collide(block, flights, i, way.distanceAt(flight.distance), largestOf(power));
}

/// Scatters a photon at a point of its ray, unless roulette ends it. before: largest component of
/// its power before the flight.
ChunkTracer::FlightEnd ChunkTracer::collide(PhotonPathBlock& block, Flights& flights, int i,
                                            float distance, float before)
{
    const MediumRecord& medium = flights.media[flights.within[i]];
    const uint32_t photon = block.photon[i], stretch = flights.stretch[i];
    const bool first = flights.bounce == 0 && !((_collided >> i) & 1u);
    const RayBlock& ray = _rays.ray;
    const Vec3 origin(ray.originX[i], ray.originY[i], ray.originZ[i]);
    const Vec3 direction = laneOf(block.direction, i), point = origin + direction * distance;
    Vec3 power = laneOf(block.power, i);
    if (first) power *= fallenOff(block.light[i], point, distance);
    // A point's power is over the extinction, which has the density of the medium there.
    const float density = std::max(medium.densityAt(point), 1e-30f);
    if (medium.isDense && storesPoints(block, flights, i))
        storePoint(block, flights, i, point, power / density);
    countCollision(block, flights, i);
    power *= medium.sigmaS;
    const float survival = std::min(1.0f, largestOf(power) / before);
    if (!(flightNumbers(photon, flights.bounce, stretch, FlightLength).y < survival))
        return FlightEnd::Dies;
    const Vec2 u = flightNumbers(photon, flights.bounce, stretch, FlightPhase);
    const Vec3 after = samplePhase(medium.phase, direction, u.x, u.y);
    return leaveCollision(block, flights, i, point, after, power / survival);
}

/// Counts a collision of a photon, and the edges that it adds to its path.
void ChunkTracer::countCollision(PhotonPathBlock& block, Flights& flights, int i)
{
    _collided |= 1u << i;
    block.direct[i] = 0;
    ++flights.steps[i];
    ++flights.stretch[i];
    if (block.met[i] == 0)
        block.late[i] = std::min(2u, block.late[i] + 1);
    else if (block.met[i] == 1)
        block.late[i] = std::max(1u, block.late[i]);
}

/// Sends a photon on from a point in a direction, unless it has collided too often.
ChunkTracer::FlightEnd ChunkTracer::leaveCollision(PhotonPathBlock& block, Flights& flights, int i,
                                                   Vec3 point, Vec3 after, Vec3 power)
{
    if (flights.steps[i] >= kMostFlights)
    {
        ++_chunk.cutWalks;
        return FlightEnd::Dies;
    }
    RayBlock& ray = _rays.ray;
    setLane(block.power, i, power);
    setLane(block.direction, i, after);
    setRay(ray, i, plainOf(point), plainOf(after), 0.0f, kInfinity);
    flights.begin[i] = 0.0f;
    return FlightEnd::GoesOn;
}

/// Takes a photon through the surface at the end of its ray, if the surface bends no light.
ChunkTracer::FlightEnd ChunkTracer::meet(PhotonPathBlock& block, Flights& flights, int i)
{
    if (!flights.hasHit(i)) return FlightEnd::Surface;
    const MediumTable& media = flights.media;
    const MediumId body = flights.bodyAt(i);
    const bool front = flights.isFront(i);
    const MediumStack behind = bodiesBehind(block.bodiesOf(i), body, front);
    const bool displaced =
        body != kOutside && media.nests() && media.at(behind) == media.at(block.bodiesOf(i));
    if (body != kOutside && (media.isInterface(flights.surface.material[i]) || displaced))
        block.bodies[i] = behind.word();
    else
    {
        // A photon that has collided no longer comes straight from its light.
        const int bounce = (_collided >> i) & 1u ? std::max(flights.bounce, 1) : flights.bounce;
        const LaneMask lane = 1u << i;
        LaneMask passed = _inputs.culls || _inputs.shadowless
                              ? passFaces(block, flights.surface, lane, bounce, flights.stretch[i])
                              : 0;
        if (!passed && _inputs.traits.panes)
            passed = passPanes(block, flights.surface, lane, bounce, flights.stretch[i]);
        if (!passed) return FlightEnd::Surface;
    }
    ++flights.stretch[i];
    flights.begin[i] = _rays.ray.tFar[i];
    goOnBehindHit(_rays.ray, i, kInfinity);
    return FlightEnd::GoesOn;
}

/// Finds the closest hits of some of the rays, and leaves the others theirs.
void ChunkTracer::traceOn(LaneMask lanes)
{
    if (!lanes) return;
    RayHitBlock found;
    found.ray = _rays.ray;
    _inputs.traced.intersector().closestHits(found, lanes, Coherence::Incoherent, kPhotonRays);
    _chunk.rays += static_cast<uint64_t>(countLanes(lanes));
    for (const int i : lanesIn(lanes))
    {
        _rays.ray.tFar[i] = found.ray.tFar[i];
        _rays.u[i] = found.u[i];
        _rays.v[i] = found.v[i];
        _rays.primitive[i] = found.primitive[i];
        _rays.geometry[i] = found.geometry[i];
        _rays.instance[i] = found.instance[i];
    }
}

/// Takes the photons of a block through media to the surfaces that they meet next.
void ChunkTracer::travel(PhotonPathBlock& block, LaneMask active, int bounce, SurfaceLanes& surface)
{
    const TracedScene& traced = _inputs.traced;
    Flights flights(traced.media(), bounce);
    std::fill_n(flights.begin.v, kLanes, 0.0f);
    loadRays(block, _rays);
    _oneSided = _seen = _collided = 0;
    LaneMask arrived = 0;
    for (LaneMask open = active; open;)
    {
        traceOn(open);
        surfacesOf(traced.surfaces(), _rays, open, flights.surface);
        LaneMask next = 0;
        for (const int i : lanesIn(open))
        {
            const MediumId body = flights.bodyAt(i);
            if (body != kOutside)
                block.bodies[i] = bodiesBefore(block.bodiesOf(i), body, flights.isFront(i)).word();
            const MediumId medium = flights.media.at(block.bodiesOf(i));
            const RayBlock& ray = _rays.ray;
            flights.within[i] = medium;
            flights.parts[i] = {};
            if (!flights.media[medium].isClear)
                flights.parts[i] = flights.media.clipped(
                    medium, Vec3(ray.originX[i], ray.originY[i], ray.originZ[i]),
                    laneOf(block.direction, i), flights.begin[i],
                    flights.hasHit(i) ? ray.tFar[i] : kInfinity);
            const FlightEnd end = fly(block, flights, i);
            next |= static_cast<LaneMask>(end == FlightEnd::GoesOn) << i;
            arrived |= static_cast<LaneMask>(end == FlightEnd::Surface) << i;
        }
        open = next;
    }
    surfacesOf(traced.surfaces(), _rays, arrived, surface);
    if (traced.traits().normalMaps) applyNormalMaps(traced, _rays, surface);
    std::fill_n(_rays.ray.tNear.v, kLanes, 0.0f);
}

/// Returns the surface model of a lane, with the index by which its bodies bend light.
const Bsdf* ChunkTracer::bsdfInBodies(const PhotonPathBlock& block, const SurfaceLanes& surface,
                                      int i)
{
    const Bsdf* const bsdf = bsdfAt(surface, i);
    if (!_inputs.traits.media || !_inputs.traced.media().nests()) return bsdf;
    const MediumTable& media = _inputs.traced.media();
    if (bsdf != &_textured[i]) _textured[i] = *bsdf;
    setRelativeIor(media, block.bodiesOf(i), media.interiorOf(surface.material[i]),
                   (surface.front >> i) & 1u, _textured[i]);
    return &_textured[i];
}

/// Takes photons into the bodies that they have been refracted into, and counts the surfaces that
/// they have met. Returns the lanes whose next surface or collision would not be too far for all
/// eyes.
LaneMask ChunkTracer::enterBodies(PhotonPathBlock& block, const SurfaceLanes& surface,
                                  LaneMask alive)
{
    const MediumTable& media = _inputs.traced.media();
    const MaterialTable& materials = _inputs.materials;
    for (const int i : lanesIn(alive))
    {
        const MediumId body = media.interiorOf(surface.material[i]);
        const bool front = (surface.front >> i) & 1u;
        const bool through =
            glm::dot(laneOf(block.direction, i), laneOf(surface.geometricNormal, i)) < 0.0f;
        const MediumStack before = block.bodiesOf(i);
        if (body != kOutside && through) block.bodies[i] = bodiesBehind(before, body, front).word();
        // From the eye's side, all of this is the inner side of a smooth body that scatters.
        const MaterialRecord& record = materials[surface.material[i]];
        const bool within = body != kOutside && front == through && ((_smooth >> i) & 1u) != 0 &&
                            media[body].scatters && media.at(block.bodiesOf(i)) == body &&
                            !record.normalMap && !record.emits;
        block.met[i] += within ? 0 : 1;
        const auto most = static_cast<uint32_t>(_inputs.options.maxBounces);
        const uint32_t next = static_cast<uint32_t>(block.met[i]) + 1 + block.late[i];
        if (next > most && edgesInMedium(block.met[i], block.late[i]) > most) alive &= ~(1u << i);
    }
    return alive;
}

} // namespace osgRayTrace::engine
