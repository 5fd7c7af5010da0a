// ChunkOpenings.cpp - what photons do that may go through openings, and how openings are learnt
// from them. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/ChunkTracer.h"

namespace osgRayTrace::engine
{

namespace
{

constexpr uint32_t kOpeningNumbers = 0x6f70656eu; // tells these dimensions from all others
constexpr uint32_t kLightNumbers = 0xffffffffu;   // in place of a bounce

} // namespace

/// Chooses the photons of _views that have children, and the ways of these, with weights. seed: of
/// the choice. Returns the lanes of the children.
LaneMask ChunkTracer::chooseChildren(const UintLanes& photons, uint32_t seed, Vec3Lanes& wi,
                                     FloatLanes& weights)
{
    FloatLanes number, choice, u, v, chosen;
    photonPoints(photons, hash(seed, 0), number, choice);
    LaneMask sent = 0;
    for (const int i : lanesIn(_views.lanes))
        sent |= static_cast<LaneMask>(number[i] < _views.children[i]) << i;
    if (!sent) return 0;
    photonPoints(photons, hash(seed, 1), u, v);
    _inputs.openings->sample(_views, choice, u, v, sent, wi, chosen);
    _inputs.openings->weigh(_views, wi, chosen, weights);
    for (const int i : lanesIn(sent))
        if (!(weights[i] > 0.0f)) sent &= ~(1u << i); // below the horizon of the normal
    return sent;
}

/// Sends children of the photons of a block through openings. Returns the lanes that may have
/// children.
LaneMask ChunkTracer::sendThroughOpenings(const PhotonPathBlock& block, const SurfaceLanes& surface,
                                          int bounce)
{
    FloatLanes power, shares, unused, roulette;
    const auto photons = static_cast<float>(_inputs.options.photons);
    const LaneMask lanes = _diffuse & _scattered.alive;
    power = {};
    _views.position = _views.normal = {};
    for (const int i : lanesIn(lanes))
    {
        power[i] = photons * luminanceOf(block.power.x[i], block.power.y[i], block.power.z[i]);
        setLane(_views.position, i, laneOf(surface.position, i));
        setLane(_views.normal, i, laneOf(_normal, i));
    }
    _inputs.openings->look(power, lanes, _views);
    if (!_views.lanes) return 0;
    const uint32_t seed = dimension(hash(kOpeningNumbers, static_cast<uint32_t>(bounce)));
    Scattered children;
    children.wi = _scattered.wi;
    children.weight = _scattered.weight;
    children.alive = chooseChildren(block.photon, seed, children.wi, shares);
    children.transmitted = children.mirrored = 0;
    if (!children.alive) return _views.lanes;
    photonPoints(block.photon, hash(seed, 2), unused, roulette);
    PhotonPathBlock copy = block;
    const LaneMask alive = leaveSurfaces(surface, _normal, children, roulette, copy);
    for (const int i : lanesIn(alive))
        setLane(copy.power, i, laneOf(copy.power, i) * shares[i]);
    _sent.append(copy, alive);
    return _views.lanes;
}

/// Records how the photons of a block have come to their surfaces.
void ChunkTracer::recordFlights(PhotonPathBlock& block, const SurfaceLanes& surface,
                                LaneMask stored)
{
    const auto photons = static_cast<float>(_inputs.options.photons);
    for (const int i : lanesIn(surface.hits))
    {
        const auto number = static_cast<uint32_t>(_chunk.flights.size());
        _chunk.flights.push_back({laneOf(block.origin, i), laneOf(surface.position, i),
                                  laneOf(surface.geometricNormal, i),
                                  photons * luminance(laneOf(block.power, i)),
                                  ((stored >> i) & 1u) != 0, block.flight[i]});
        block.flight[i] = number;
    }
}

/// Sends children of photons from their lights through openings. Photons leave parallelograms by
/// the cosine, as they leave matt surfaces, unless they are guided to what makes caustics.
void ChunkTracer::sendFromLights(PhotonPathBlock& block, LaneMask lanes)
{
    if (_inputs.emitter.hasTargets()) return;
    const auto photons = static_cast<float>(_inputs.options.photons);
    FloatLanes power = {}, shares;
    _views.position = _views.normal = {};
    LaneMask even = 0;
    for (const int i : lanesIn(lanes))
    {
        if (_inputs.lights[block.light[i]].kind != LightKind::Parallelogram) continue;
        const Vec3 normal = _inputs.traced.lights().normal(block.light[i]);
        const bool front = glm::dot(normal, laneOf(block.direction, i)) > 0.0f;
        even |= 1u << i;
        power[i] = photons * luminance(laneOf(block.power, i));
        setLane(_views.position, i, laneOf(block.origin, i));
        setLane(_views.normal, i, front ? normal : -normal);
    }
    if (!even) return;
    _inputs.openings->look(power, even, _views);
    if (!_views.lanes) return;
    PhotonPathBlock children = block;
    const LaneMask sent = chooseChildren(
        block.photon, dimension(hash(kOpeningNumbers, kLightNumbers)), children.direction, shares);
    for (const int i : lanesIn(sent))
        setLane(children.power, i, laneOf(block.power, i) * shares[i]);
    _sent.append(children, sent);
    _inputs.openings->weigh(_views, block.direction, FloatLanes{}, shares);
    for (const int i : lanesIn(_views.lanes))
        setLane(block.power, i, laneOf(block.power, i) * shares[i]);
}

} // namespace osgRayTrace::engine
