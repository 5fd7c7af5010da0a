// ChunkTracer.cpp - what photons do at the surfaces that they meet. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/ChunkTracer.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/MergeHits.h"
#include "osgRayTrace/accel/NormalMaps.h"
#include "osgRayTrace/accel/SurfaceAttributes.h"
#include "osgRayTrace/accel/SurfaceTangents.h"
#include "osgRayTrace/sampling/Warp.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns whether a surface looks up photons: one that mirrors alone, or that light passes
/// unbent, has no use for them.
bool storesPhotons(const Bsdf& bsdf)
{
    if (bsdf.diffuse != Vec3(0.0f) || bsdf.diffuseTransmission != Vec3(0.0f)) return true;
    return !bsdf.isSmooth() && (bsdf.reflects() || (bsdf.transmits() && bsdf.eta != 1.0f));
}

/// Returns the lanes whose power is finite.
OSGRAYTRACE_KERNEL
LaneMask finiteLanes(const Vec3Lanes& power)
{
    LaneMask finite = 0;
    OSGRAYTRACE_SIMD_OR(finite)
    for (int i = 0; i < kLanes; ++i)
        finite |= bitOfLane(maskOf(std::fabs(power.x[i]) < kInfinity) &
                                maskOf(std::fabs(power.y[i]) < kInfinity) &
                                maskOf(std::fabs(power.z[i]) < kInfinity),
                            i);
    return finite;
}

/// Returns a number of a face. A photon that media scatter may meet a face again.
uint32_t faceKey(uint32_t instance, uint32_t primitive, uint32_t stretch)
{
    const uint32_t face = hash(instance, primitive);
    return stretch == 0 ? face : hash(face, stretch);
}

} // namespace

/// Returns the point at which the material of a lane's surface is asked for.
MaterialPoint ChunkTracer::pointAt(const SurfaceLanes& surface, int i) const
{
    const MaterialRecord& record = _inputs.materials[surface.material[i]];
    const RayBlock& ray = _rays.ray;
    const Vec3 direction(ray.directionX[i], ray.directionY[i], ray.directionZ[i]);
    return materialPointOf(_inputs.traced.surfaces()[surface.instance[i]], record,
                           _rays.primitive[i], _rays.u[i], _rays.v[i], (surface.front >> i) & 1u,
                           direction);
}

/// Returns the surface model of a lane, which stays until the next block.
const Bsdf* ChunkTracer::bsdfAt(const SurfaceLanes& surface, int i)
{
    const MaterialRecord& record = _inputs.materials[surface.material[i]];
    const bool front = (surface.front >> i) & 1u;
    if (record.constant && !record.pane) return front ? &record.front : &record.back;
    _textured[i] = _inputs.materials.bsdf(surface.material[i], pointAt(surface, i));
    // passPanes has taken this lobe.
    if (_textured[i].thin && _textured[i].isSmooth()) _textured[i].transmission = Vec3(0.0f);
    return &_textured[i];
}

/// Returns the factor on the power of a photon that has come straight from a light to a point.
float ChunkTracer::fallenOff(uint32_t number, Vec3 point, float way) const
{
    const Light& light = _inputs.lights[number];
    const float distance =
        isSoft(light) ? std::max(light.radius, glm::length(point - light.position)) : way;
    return _inputs.emitter.falloff(number, distance);
}

/// Drops the lanes on surfaces that their lights are switched off for, and applies the falloff of
/// fixed-function lights.
void ChunkTracer::leaveLight(PhotonPathBlock& block, SurfaceLanes& surface) const
{
    for (const int i : lanesIn(surface.hits & ~_collided))
    {
        const Light& light = _inputs.lights[block.light[i]];
        if (light.kind != LightKind::Point && light.kind != LightKind::Directional) continue;
        const Material& material = _inputs.traced.scene().materials[surface.material[i]];
        if (!isLightEnabled(material, light.number)) surface.hits &= ~(1u << i);
        const float falloff =
            fallenOff(block.light[i], laneOf(surface.position, i), _rays.ray.tFar[i]);
        block.power.x[i] *= falloff;
        block.power.y[i] *= falloff;
        block.power.z[i] *= falloff;
    }
}

/// Lets the bodies whose inner sides photons have met absorb.
void ChunkTracer::absorb(PhotonPathBlock& block, const SurfaceLanes& surface) const
{
    for (const int i : lanesIn(surface.hits & ~surface.front))
    {
        const MaterialRecord& record = _inputs.materials[surface.material[i]];
        if (!record.absorbs) continue;
        setLane(block.power, i,
                laneOf(block.power, i) * transmittanceOver(record, _rays.ray.tFar[i]));
    }
}

/// Returns whether no look-up would ever read a photon: glossy surfaces look up caustics alone that
/// have met nothing but mirrors. The mean of a textured surface may be rough although a point is
/// glossy.
bool ChunkTracer::isUnread(const PhotonPathBlock& block, const SurfaceLanes& surface, int i) const
{
    if (!_inputs.materials[surface.material[i]].constant) return false;
    return _inputs.options.use != PhotonUse::Caustics || block.direct[i] == 0;
}

/// Stores the photons of lanes; those whose power is not finite are counted instead.
void ChunkTracer::store(const PhotonPathBlock& block, const SurfaceLanes& surface, LaneMask lanes,
                        int bounce)
{
    for (const int i : lanesIn(lanes & _glossy))
        if (isUnread(block, surface, i)) lanes &= ~(1u << i);
    const LaneMask stored = lanes & finiteLanes(block.power);
    if (lanes != stored) _chunk.dropped += static_cast<uint64_t>(countLanes(lanes & ~stored));
    if (!stored) return;
    Photon* const room = _chunk.photons.room(kLanes);
    Photon* photon = room;
    for (const int i : lanesIn(stored))
        *photon++ = {laneOf(surface.position, i),
                     -laneOf(block.direction, i),
                     laneOf(block.power, i),
                     laneOf(surface.geometricNormal, i),
                     edgesAt(block, i, bounce),
                     block.direct[i] != 0,
                     _chunk.bins[block.photon[i] - _first]};
    _chunk.photons.push(static_cast<uint32_t>(photon - room));
}

/// Samples the surface model of one lane, of any kind.
void ChunkTracer::scatterOne(const PhotonPathBlock& block, const SurfaceLanes& surface, int i,
                             bool mustMirror)
{
    const Vec3 normal = laneOf(_normal, i), direction = laneOf(block.direction, i);
    const Bsdf* bsdf = _bsdfs[i];
    Bsdf aligned;
    if (bsdf->needsAxes() && !((_aligned >> i) & 1u))
    {
        aligned = *bsdf;
        alignLayers(_inputs.traced, _rays, surface, i, normal, aligned);
        bsdf = &aligned;
    }
    Vec3 tangent, bitangent;
    frameOf(normal.x, normal.y, normal.z, tangent, bitangent);
    const Vec3 wo(-glm::dot(direction, tangent), -glm::dot(direction, bitangent),
                  -glm::dot(direction, normal));
    const std::optional<BsdfSample> sample =
        sampleBsdf(*bsdf, wo, _lobe[i], _u[i], _v[i], Transport::Importance);
    if (!sample || (mustMirror && !sample->delta)) return;
    const Vec3 wi = tangent * sample->wi.x + bitangent * sample->wi.y + normal * sample->wi.z;
    setLane(_scattered.wi, i, wi);
    setLane(_scattered.weight, i, sample->weight);
    _scattered.alive |= 1u << i;
    _scattered.transmitted |= static_cast<LaneMask>(sample->transmitted) << i;
    _scattered.mirrored |= static_cast<LaneMask>(sample->delta) << i;
}

/// Sends the photons of a block on from their surfaces.
void ChunkTracer::scatter(PhotonPathBlock& block, const SurfaceLanes& surface, int bounce)
{
    const LaneMask mustMirror = mirrorsOnly(bounce);
    if (mustMirror) _diffuse = 0;
    if (!(_diffuse | _smooth | _general)) return;
    facingNormalLanes(_rays.ray, surface, _normal);
    const uint32_t lobeAndRoulette = dimension(bounceNumber(bounce) + 1);
    if (_smooth | _general)
        photonPoints(block.photon, lobeAndRoulette, _lobe, _roulette);
    else
        secondPhotonPoints(block.photon, lobeAndRoulette, _roulette);
    if (_diffuse | _general) photonPoints(block.photon, dimension(bounceNumber(bounce)), _u, _v);

    if (_diffuse) diffuseDirections(_normal, _u, _v, _scattered.wi);
    _scattered.alive = _diffuse;
    _scattered.transmitted = _scattered.mirrored = 0;
    if (_smooth)
    {
        const IncidentLanes incident{block.direction.x, block.direction.y, block.direction.z,
                                     _normal};
        const SmoothLanes sampled =
            sampleSmoothLanes(_interfaces, incident, _lobe, _smooth, Transport::Importance,
                              _scattered.wi, _scattered.weight);
        _scattered.alive |= sampled.alive;
        _scattered.transmitted = sampled.transmitted;
        _scattered.mirrored = _smooth;
    }
    for (const int i : lanesIn(_general))
        scatterOne(block, surface, i, ((mustMirror >> i) & 1u) != 0);
    _scattered.alive &= ~(_oneSided & ~(_seen ^ _scattered.transmitted));
    FloatLanes shares;
    const LaneMask splits = _inputs.openings ? sendThroughOpenings(block, surface, bounce) : 0;
    if (splits) _inputs.openings->weigh(_views, _scattered.wi, FloatLanes{}, shares);
    LaneMask alive = leaveSurfaces(surface, _normal, _scattered, _roulette, block);
    for (const int i : lanesIn(alive & splits))
        setLane(block.power, i, laneOf(block.power, i) * shares[i]);
    if (_inputs.traits.media) alive = enterBodies(block, surface, alive);
    _paths.append(block, alive);
}

/// Sorts the lanes by what their surfaces are; returns those that photons are stored at.
LaneMask ChunkTracer::classify(const PhotonPathBlock& block, const SurfaceLanes& surface)
{
    const MaterialTable& materials = _inputs.materials;
    LaneMask stores = 0;
    _diffuse = _smooth = _general = _glossy = _aligned = 0;
    for (const int i : lanesIn(surface.hits))
    {
        const LaneMask lane = 1u << i;
        const MaterialRecord& record = materials[surface.material[i]];
        if (record.plainDiffuse)
        {
            setLane(_scattered.weight, i, record.front.diffuse);
            if (record.front.diffuse != Vec3(0.0f)) _diffuse |= lane;
            continue;
        }
        const Bsdf* const bsdf = bsdfInBodies(block, surface, i);
        if (isSmoothInterface(*bsdf))
        {
            _interfaces.set(i, *bsdf);
            _smooth |= lane;
            continue;
        }
        _bsdfs[i] = bsdf;
        _general |= lane;
        if (bsdf->isGlossy()) _glossy |= lane;
        if (storesPhotons(*bsdf)) stores |= lane;
    }
    return stores | _diffuse;
}

/// Lets half of the photons go on, twice as bright, where a surface is lit and lets light through
/// all the same. All surfaces are such for photons that come straight from a light without shadows.
/// For other photons those faces are that all rays pass from one side, if photons meet the side
/// that is seen. A path from the eye meets that side only, so light that leaves on the other side
/// is part of no path: scatter() absorbs it. Returns the lanes that go on.
LaneMask ChunkTracer::passFaces(PhotonPathBlock& block, const SurfaceLanes& surface, LaneMask lanes,
                                int bounce, uint32_t stretch)
{
    LaneMask passed = 0;
    for (const int i : lanesIn(lanes & surface.hits))
    {
        const Material& material = *_inputs.materials[surface.material[i]].material;
        const LaneMask lane = 1u << i;
        bool passes = bounce == 0 && !_inputs.lights[block.light[i]].castsShadows;
        if (material.cullsAllRays)
        {
            _oneSided |= lane;
            if (!isCulled(material, isFrontFace(material, (surface.front >> i) & 1u)))
            {
                _seen |= lane;
                passes = true;
            }
        }
        if (!passes) continue;
        setLane(block.power, i, 2.0f * laneOf(block.power, i));
        const uint32_t face = faceKey(surface.instance[i], _rays.primitive[i], stretch);
        if (hash(hash(dimension(bounceNumber(bounce)), block.photon[i]), face) & 0x80000000u)
            passed |= lane;
    }
    _oneSided &= ~passed;
    _seen &= ~passed;
    return passed;
}

/// Lets photons pass panes straight, as passPanes does for rays from the eye, of which they are no
/// bounce: light samples take the same way. Returns the lanes that go on.
LaneMask ChunkTracer::passPanes(PhotonPathBlock& block, const SurfaceLanes& surface, LaneMask lanes,
                                int bounce, uint32_t stretch)
{
    const MaterialTable& materials = _inputs.materials;
    LaneMask passed = 0;
    for (const int i : lanesIn(lanes & surface.hits))
    {
        const uint32_t material = surface.material[i];
        if (!materials[material].pane) continue;
        const Vec3 direction = laneOf(block.direction, i);
        const float cosine = std::fabs(glm::dot(laneOf(surface.shadingNormal, i), direction));
        const bool front = (surface.front >> i) & 1u;
        const MaterialPoint point =
            materialPointOf(_inputs.traced.surfaces()[surface.instance[i]], materials[material],
                            _rays.primitive[i], _rays.u[i], _rays.v[i], front, direction);
        const Vec3 share = materials.pane(material, point, cosine);
        const float p = std::min(std::max(share.x, std::max(share.y, share.z)), 1.0f);
        if (!(p > 0.0f)) continue;
        const uint32_t face =
            faceKey(surface.instance[i] + 0x70616e65u, _rays.primitive[i], stretch);
        const uint32_t key = hash(hash(dimension(bounceNumber(bounce)), block.photon[i]), face);
        const bool goesOn = p > 1.0f - 1e-6f || unitFloat(key) < p;
        const Vec3 weight = goesOn ? share / p : Vec3(1.0f / (1.0f - p));
        setLane(block.power, i, laneOf(block.power, i) * weight);
        passed |= static_cast<LaneMask>(goesOn) << i;
    }
    return passed;
}

/// Finds the surfaces that rays meet next.
void ChunkTracer::meetSurfaces(RayHitBlock& rays, LaneMask lanes, SurfaceLanes& surface)
{
    const TracedScene& traced = _inputs.traced;
    traced.intersector().closestHits(rays, lanes, Coherence::Incoherent, kPhotonRays);
    _chunk.rays += static_cast<uint64_t>(countLanes(lanes));
    surfacesOf(traced.surfaces(), rays, lanes, surface);
    if (traced.traits().normalMaps) applyNormalMaps(traced, rays, surface);
}

/// Finds the surfaces behind those that photons have passed.
void ChunkTracer::meetBehind(LaneMask passed, SurfaceLanes& surface)
{
    RayBlock& ray = _rays.ray;
    for (const int i : lanesIn(passed))
    {
        ray.tNear[i] = std::nextafter(ray.tFar[i], kInfinity);
        ray.tFar[i] = kInfinity;
    }
    RayHitBlock behind;
    behind.ray = ray;
    SurfaceLanes next;
    meetSurfaces(behind, passed, next);
    mergeHits(behind, next, passed, _rays, surface);
}

/// Finds the surfaces that the photons of a block meet and do not pass.
void ChunkTracer::findSurfaces(PhotonPathBlock& block, LaneMask active, int bounce,
                               SurfaceLanes& surface)
{
    loadRays(block, _rays);
    _oneSided = _seen = 0;
    meetSurfaces(_rays, active, surface);
    const bool panes = _inputs.traits.panes;
    const bool facesPass = _inputs.culls || (bounce == 0 && _inputs.shadowless);
    if (!facesPass && !panes) return;
    for (LaneMask lanes = active;;)
    {
        const LaneMask passed = facesPass ? passFaces(block, surface, lanes, bounce) : 0;
        lanes = passed | (panes ? passPanes(block, surface, lanes & ~passed, bounce) : 0);
        if (!lanes) break;
        meetBehind(lanes, surface);
    }
    std::fill_n(_rays.ray.tNear.v, kLanes, 0.0f);
}

} // namespace osgRayTrace::engine
