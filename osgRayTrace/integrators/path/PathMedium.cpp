// PathMedium.cpp - takes paths through participating media to the next surface. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// The radiance that arrives along a ray is [Chandrasekhar60, sect. 7]
//
//   L = T(d) L_surface + integral over t from 0 to d of T(t) (j + sigmaS integral of p L_i dw) dt
//
// with T(t) = exp(-sigmaT t). The emission j is integrated in closed form. Of the second integral,
// light that comes straight from lights is sampled by SegmentLights.h. All other light is found by
// a collision, which free flights find with RGB weights (FreeFlight.h) and which goes on by the
// phase function; absorption is a weight, not an end. A light that a path meets straight after a
// collision counts for nothing, as SegmentLights.h has sampled it; the sky is weighted against its
// samples by the power heuristic, with the densities of place and direction of both.
#include "osgRayTrace/integrators/path/PathMediumWalk.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/SingleSurface.h"
#include "osgRayTrace/integrators/shared/FirstHit.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/Panes.h"
#include "osgRayTrace/media/FreeFlight.h"
#include "osgRayTrace/media/PhaseFunction.h"
#include "osgRayTrace/media/Transmittance.h"
#include "osgRayTrace/photons/VolumePhotons.h"
#include "osgRayTrace/shading/SmoothLanes.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

float largestOf(Vec3 v)
{
    return std::max(v.x, std::max(v.y, v.z));
}

} // namespace

/// Finds the stretches of the open paths up to the next surface.
void MediumWalk::findSegments(int step)
{
    surfacesOf(_traced.surfaces(), _block.rays, _open, _surface);
    const RayBlock& ray = _block.rays.ray;
    _segments.ray = &ray;
    _segments.lanes = 0;
    _segments.eachLight = step == 0;
    _segments.withMis = _collides && (_use != PhotonUse::Indirect || _causticsAlone);
    for (const int i : lanesIn(_open))
    {
        const MediumId body = bodyAt(i);
        if (body != kOutside) _block.bodies[i] = bodiesBefore(_block.bodies[i], body, isFront(i));
        const MediumId medium = _media.at(_block.bodies[i]);
        _segments.media[i] = medium;
        _segments.bodies[i] = _block.bodies[i];
        _segments.numbers[i] =
            MediumNumbers(_block.seed[i], _tile.context.pathKey.index, _number, step);
        _segments.parts[i] = {};
        const bool isClear = _media[medium].isClear;
        if (isClear && !_grids) continue;
        const Vec3 origin(ray.originX[i], ray.originY[i], ray.originZ[i]);
        const float end = hasHit(i) ? ray.tFar[i] : kInfinity;
        if (!isClear)
            _segments.parts[i] =
                _media.clipped(medium, origin, directionOf(ray, i), _begin[i], end);
        if (_media[medium].scatters && !_segments.parts[i].isEmpty() && !_last)
            _segments.lanes |= 1u << i;
        if (_grids) findGrids(i, origin, end);
    }
}

/// Adds the light that the stretches scatter and emit towards their rays.
void MediumWalk::addLight()
{
    _segments.throughput = _block.throughput;
    Vec3Lanes radiance;
    for (const int i : lanesIn(_open))
    {
        const MediumRecord& medium = _media[_segments.media[i]];
        const RayPart& part = _segments.parts[i];
        Vec3 emitted(0.0f);
        if (medium.emits && !part.isEmpty() && !_segments.gridsOf(i))
            emitted = laneOf(_block.throughput, i) *
                      emittedAlong(medium.emission, medium.sigmaT, _segments.lengthOf(i, medium));
        setLane(radiance, i, emitted);
    }
    addSegmentLights(_tile.context, _tile.deltaLights, _segments, _tile.counts, radiance);
    for (const int i : lanesIn(_open))
        _tile.sums.add(_block.flagsOf(i), laneOf(radiance, i));
}

/// Adds the light that photons bring to the stretches of paths that have looked up none before.
void MediumWalk::addPhotonBeams(int step)
{
    if (_use == PhotonUse::None || !_tile.context.volumePhotons) return;
    LaneMask lanes = 0;
    for (const int i : lanesIn(_segments.lanes))
        lanes |= static_cast<LaneMask>(!_block.flagsOf(i).hasTaken()) << i;
    for (const int i : lanesIn(_grids ? lanes : 0))
        if (!_media[_segments.media[i]].isThin()) lanes &= ~(1u << i);
    addBeams(_tile, _block, _segments, lanes, _number, _number == 0 && step == 0);
}

/// Sets the boundary of the medium that is next to a collision, the surface that the ray has come
/// from or the one that it would meet, and the other one if the medium is a slab between both.
void MediumWalk::findBoundary(int i, float distance, PointQuery& query)
{
    constexpr float kParallel = 0.9f; // cosine of the angle between the faces of a slab
    const Vec3 direction = -query.towards;
    const auto keep = [&](Vec3 normal, float away, float side)
    {
        const float cosine = glm::dot(normal, direction), depth = std::fabs(cosine) * away;
        const Vec3 inwards = cosine * side < 0.0f ? -normal : normal;
        const bool isSlab = glm::dot(inwards, query.inwards) < -kParallel;
        if (depth < query.depth)
        {
            query.beyond = isSlab ? query.depth : kInfinity;
            query.depth = depth;
            query.inwards = inwards;
        }
        else if (isSlab)
            query.beyond = depth;
    };
    if (hasHit(i))
        keep(laneOf(_surface.geometricNormal, i), _block.rays.ray.tFar[i] - distance, -1.0f);
    const auto hit =
        _traced.intersector().closestHit(query.position, query.towards, 0.0f, kInfinity, {});
    ++_tile.counts.secondaryRays;
    if (!hit) return;
    const SingleSurface met(_traced, query.position, query.towards, *hit);
    keep(laneOf(met.surface.geometricNormal, 0), hit->t, 1.0f);
}

/// Adds the light that photons bring to a collision of a path that has looked up none before.
/// throughput: after the collision with a homogeneous medium, or before that with what is here.
void MediumWalk::addPhotonPoints(int i, float distance, Vec3 throughput, const Scatterers* here)
{
    const PassContext& context = _tile.context;
    if (_use == PhotonUse::None || !context.volumePhotons || _block.flagsOf(i).hasTaken()) return;
    const RayBlock& ray = _block.rays.ray;
    PointQuery query;
    query.towards = -directionOf(ray, i);
    query.position =
        Vec3(ray.originX[i], ray.originY[i], ray.originZ[i]) - query.towards * distance;
    query.radius = context.pointRadius;
    if (!here) findBoundary(i, distance, query);
    query.medium = _segments.media[i];
    query.phase = _media[query.medium].phase;
    query.mostEdges = static_cast<uint32_t>(context.options.maxBounces - _number);
    const PointMap& points = context.volumePhotons->points;
    const Vec3 radiance = throughput * (here ? points.gather(query, *here) : points.gather(query));
    _tile.sums.add(_block.flagsOf(i), radiance);
    if (GatheredPhotons* gathered = _tile.result.photons.gathered)
        gathered->carried += luminance(radiance);
}

/// Takes a path along its stretch.
MediumWalk::End MediumWalk::travel(int i)
{
    const RayPart& part = _segments.parts[i];
    if (part.isEmpty()) return meet(i);
    if (const GridRay* grids = _segments.gridsOf(i)) return travelGrids(i, *grids);
    const MediumRecord& medium = _media[_segments.media[i]];
    const float length = _segments.lengthOf(i, medium);
    const Vec3 throughput = laneOf(_block.throughput, i);
    const bool beamsOnly = _use == PhotonUse::Indirect && !medium.isDense && !_causticsAlone;
    if (!medium.scatters || !_collides || beamsOnly)
    {
        setLane(_block.throughput, i, throughput * transmittance(medium.sigmaT, length));
        return meet(i);
    }
    const FreeFlight flight =
        sampleFlight(medium.sigmaT, length, channelPmf(throughput), _flights[i]);
    setLane(_block.throughput, i, throughput * flight.weight);
    return flight.collides ? collide(i, _segments.distanceAt(i, medium, flight.distance)) : meet(i);
}

/// Counts a collision, and sets the throughput behind it unless the path ends there.
bool MediumWalk::survives(int i, Vec3 throughput)
{
    ++_tile.counts.collisions;
    _collided |= 1u << i;
    if (_use == PhotonUse::Indirect && !_causticsAlone) return false; // photons have all else
    if (++_collisions[i] > kMostCollisions)
    {
        ++_tile.counts.cutWalks;
        return false;
    }
    if (static_cast<uint32_t>(_number) + _collisions[i] >= kRouletteBounce)
    {
        const float wanted =
            largestOf(throughput) * _block.etaScale[i] * (1.0f / kRouletteThroughput);
        const float survival = std::min(wanted, 1.0f);
        if (!(_survivals[i] < survival)) return false;
        throughput /= survival;
    }
    if (throughput == Vec3(0.0f)) return false;
    setLane(_block.throughput, i, throughput);
    return true;
}

PathFlags MediumWalk::flagsAfterCollision(int i) const
{
    const PathFlags path = _block.flagsOf(i);
    if (_use == PhotonUse::None) return path.collided();
    return _causticsAlone ? path.collidedAmongCaustics() : path.collidedAmongPhotons();
}

/// Scatters a path at a point of its ray, unless roulette ends it.
MediumWalk::End MediumWalk::collide(int i, float distance)
{
    const MediumRecord& medium = _media[_segments.media[i]];
    const MediumNumbers& numbers = _segments.numbers[i];
    const Vec3 throughput = laneOf(_block.throughput, i) * medium.sigmaS;
    const RayBlock& ray = _block.rays.ray;
    const Vec3 before = directionOf(ray, i);
    const Vec3 point = Vec3(ray.originX[i], ray.originY[i], ray.originZ[i]) + before * distance;
    if (medium.isDense) addPhotonPoints(i, distance, throughput);
    const float found = collisionProbability(_tile.context, _segments, i);
    if (!survives(i, throughput)) return End::Dies;
    const Vec2 u = numbers.at(MediumPhase);
    const Vec3 after = samplePhase(medium.phase, before, u.x, u.y);
    // The density with which collisions find the sky, over that of SegmentLights' choice of place.
    _block.pdfW[i] = found * evalPhase(medium.phase, glm::dot(before, after));
    _block.flags[i] = flagsAfterCollision(i).word();
    spawn(i, {point, 0.0f}, after);
    return End::GoesOn;
}

/// Takes a path through the surface at the end of its ray, if the surface bends no light or belongs
/// to the walk.
MediumWalk::End MediumWalk::meet(int i)
{
    if (!hasHit(i)) return End::Surface;
    const uint32_t material = _surface.material[i];
    const MediumId body = _media.interiorOf(material);
    const bool pane = _traced.materials()[material].pane;
    if (pane && goesThroughPane(_tile.context, _block.rays, _surface, i, _block.throughput))
        ++_tile.counts.secondaryRays;
    else if (body != kOutside && (_media.isInterface(material) || isDisplaced(i, body)))
        _block.bodies[i] = bodiesBehind(_block.bodies[i], body, isFront(i));
    else
    {
        End end = End::Surface;
        if (!passBoundary(i, end)) return End::Surface;
        return end;
    }
    _begin[i] = _block.rays.ray.tFar[i];
    goOnBehindHit(_block.rays.ray, i, kInfinity);
    return End::GoesOn;
}

/// Reflects or refracts a path at the inner side of a smooth body that scatters: until it comes out
/// of the body, all of that is one walk, however often the surface sends the path back. Returns
/// false if the surface is not of this kind.
bool MediumWalk::passBoundary(int i, End& end)
{
    const MediumRecord& medium = _media[_segments.media[i]];
    if (!_collides || isFront(i) || !medium.scatters || bodyAt(i) != _segments.media[i])
        return false;
    const uint32_t material = _surface.material[i];
    const MaterialRecord& record = _traced.materials()[material];
    if (record.normalMap || record.emits) return false;
    Bsdf bsdf = record.constant
                    ? record.back
                    : _traced.materials().bsdf(
                          material, materialPoint(_tile.context, _block.rays, _surface, i));
    setRelativeIor(_media, _block.bodies[i], bodyAt(i), false, bsdf);
    if (!isSmoothInterface(bsdf) || bsdf.needsAxes()) return false;
    const ShadingFrame frame(facingNormal(_block.rays, _surface, i));
    const Vec3 wo = frame.toLocal(-directionOf(_block.rays.ray, i));
    const Vec2 u = _segments.numbers[i].at(MediumBoundary);
    const std::optional<BsdfSample> sample = sampleBsdf(bsdf, wo, u.x, 0.5f, 0.5f);
    end = End::Dies;
    if (!sample) return true;
    const Vec3 direction = frame.toWorld(sample->wi);
    if (isAboveFacet(_surface, i, direction) == sample->transmitted) return true;
    if (++_collisions[i] > kMostCollisions)
    {
        ++_tile.counts.cutWalks;
        return true;
    }
    setLane(_block.throughput, i, laneOf(_block.throughput, i) * sample->weight);
    if (sample->transmitted)
    {
        const float eta = bsdf.transmittedEta();
        _block.etaScale[i] *= eta * eta;
        _block.bodies[i] = _block.bodies[i].left(bodyAt(i));
    }
    _block.pdfW[i] = kInfinity;
    _block.flags[i] = PathFlags::afterSurface(_block.flags[i], 0u, 0u, 0u, ~0u);
    spawn(i, leaveFacet(_surface, i, direction), direction);
    end = End::GoesOn;
    return true;
}

void MediumWalk::spawn(int i, const RayBegin& begin, Vec3 direction)
{
    setRay(_block.rays.ray, i, begin, direction, kInfinity);
    _begin[i] = begin.tNear;
}

/// Finds the closest hits of some of the rays, and leaves the others theirs.
void MediumWalk::trace(LaneMask lanes)
{
    if (!lanes) return;
    RayHitBlock found;
    found.ray = _block.rays.ray;
    _traced.intersector().closestHits(found, lanes, Coherence::Incoherent);
    const auto rays = static_cast<uint64_t>(countLanes(lanes));
    _tile.counts.secondaryRays += rays;
    countRays(_tile, _block, lanes);
    RayHitBlock& to = _block.rays;
    for (const int i : lanesIn(lanes))
    {
        to.ray.tFar[i] = found.ray.tFar[i];
        to.u[i] = found.u[i];
        to.v[i] = found.v[i];
        to.primitive[i] = found.primitive[i];
        to.geometry[i] = found.geometry[i];
        to.instance[i] = found.instance[i];
    }
}

LaneMask MediumWalk::run()
{
    for (int step = 0; _open; ++step)
    {
        findSegments(step);
        addLight();
        addPhotonBeams(step);
        if (_segments.lanes) setNumbers(_segments.numbers, MediumFlight, _flights, _survivals);
        LaneMask next = 0;
        for (const int i : lanesIn(_open))
        {
            const End end = travel(i);
            next |= static_cast<LaneMask>(end == End::GoesOn) << i;
            if (end == End::Dies) _block.active &= ~(1u << i);
        }
        trace(next);
        _open = next;
    }
    return _collided;
}

LaneMask travelMedia(Tile& tile, PathBlock& block, int number, bool last, PhotonUse use)
{
    const LaneMask before = block.active;
    const LaneMask collided = MediumWalk(tile, block, number, last, use).run();
    for (const int i : lanesIn(number == 0 ? before : 0))
    {
        // The background shows through what is left of its light, see addEnvironment.
        const Vec3 left = laneOf(block.throughput, i);
        const bool through = ((block.active & ~collided) >> i) & 1u;
        tile.sums.a[block.flagsOf(i).pixel()] =
            through ? std::clamp(1.0f - (left.x + left.y + left.z) / 3.0f, 0.0f, 1.0f) : 1.0f;
    }
    return collided;
}

void enterBodies(const Tile& tile, PathBlock& block, const Bounce& bounce)
{
    const MediumTable& media = tile.context.traced->media();
    for (const int i : lanesIn(block.active & bounce.surface.hits))
    {
        const MediumId body = media.interiorOf(bounce.surface.material[i]);
        if (body == kOutside) continue;
        if (isAboveFacet(bounce.surface, i, directionOf(block.rays.ray, i))) continue;
        block.bodies[i] = bodiesBehind(block.bodies[i], body, (bounce.surface.front >> i) & 1u);
    }
}

void dimSamples(const Tile& tile, const PathBlock& block, const Bounce& bounce, LaneMask visible,
                LightLanes& samples)
{
    const MediumTable& media = tile.context.traced->media();
    MediumLanes bodies = block.bodies;
    for (const int i : lanesIn(visible))
    {
        const MediumId body = media.interiorOf(bounce.surface.material[i]);
        if (body == kOutside || isAboveFacet(bounce.surface, i, laneOf(samples.wi, i))) continue;
        bodies[i] = bodiesBehind(bodies[i], body, (bounce.surface.front >> i) & 1u);
    }
    dimByMedia(tile.context, bodies, visible, samples);
}

} // namespace osgRayTrace::engine
