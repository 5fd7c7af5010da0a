// PhotonTracer.cpp - follows photons from the lights to the surfaces they are stored on. Layer:
// photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonTracer.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/SurfaceAttributes.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/photons/PhotonPaths.h"
#include "osgRayTrace/sampling/Sampler.h"
#include "osgRayTrace/sampling/Warp.h"
#include "osgRayTrace/shading/SmoothLanes.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr uint32_t kChunk = 2048; ///< photons that are followed together

/// Dimensions of a photon's sequence.
enum PhotonDimension : uint32_t
{
    EmissionChoice = 0, ///< light, choice
    EmissionPosition = 1,
    EmissionDirection = 2,
    BounceFirst = 3, ///< then for each bounce: direction; lobe and roulette
};

struct Chunk
{
    std::vector<Photon> photons;
    std::vector<uint32_t> bins; ///< of PhotonGuide, a photon that was emitted
    uint64_t rays = 0;
    uint64_t dropped = 0;
};

class ChunkTracer
{
public:
    ChunkTracer(const TracedScene& traced, const std::vector<Light>& lights,
                const PhotonEmitter& emitter, const PhotonGuide* photonGuide,
                const PhotonPassOptions& options, uint32_t passSeed, bool culls, Chunk& chunk)
        : _traced(traced),
          _lights(lights),
          _emitter(emitter),
          _photonGuide(photonGuide),
          _options(options),
          _seed(passSeed),
          _culls(culls),
          _shadowless(std::any_of(lights.begin(), lights.end(),
                                  [](const Light& light) { return !light.castsShadows; })),
          _chunk(chunk)
    {
    }

    void trace(uint32_t first, uint32_t count);

private:
    uint32_t dimension(uint32_t number) const { return dimensionSeed(_seed, number); }
    static uint32_t bounceNumber(int bounce)
    {
        return BounceFirst + 2 * static_cast<uint32_t>(bounce);
    }

    /// Other photons are not wanted.
    bool mustReflect(int bounce) const
    {
        return bounce == 0 && _options.use == PhotonUse::Caustics;
    }

    void emitBlock(uint32_t first, uint32_t count);
    void follow(PhotonPathBlock block, LaneMask active, int bounce);
    void findSurfaces(PhotonPathBlock& block, LaneMask active, int bounce, SurfaceLanes& surface);
    LaneMask passFaces(PhotonPathBlock& block, const SurfaceLanes& surface, LaneMask lanes,
                       int bounce);
    void leaveLight(PhotonPathBlock& block, SurfaceLanes& surface) const;
    LaneMask classify(const SurfaceLanes& surface);
    void store(const PhotonPathBlock& block, const SurfaceLanes& surface, LaneMask lanes,
               int bounce);
    void scatter(PhotonPathBlock& block, const SurfaceLanes& surface, int bounce);
    void scatterOne(const PhotonPathBlock& block, int i, bool mustMirror);
    const Bsdf* bsdfAt(const SurfaceLanes& surface, int i);

    const TracedScene& _traced;
    const std::vector<Light>& _lights;
    const PhotonEmitter& _emitter;
    const PhotonGuide* _photonGuide;
    const PhotonPassOptions& _options;
    uint32_t _seed;
    bool _culls;      ///< there are faces of which all rays pass one side
    bool _shadowless; ///< there are lights without shadows
    Chunk& _chunk;
    uint32_t _first = 0; ///< photon of the chunk
    PhotonPathQueue _paths{kChunk};
    // Of the block at work.
    RayHitBlock _rays;
    FloatLanes _u, _v, _lobe, _roulette; ///< of its bounce
    Vec3Lanes _normal;                   ///< shading, on the side of the ray
    LaneMask _diffuse = 0; ///< lanes on plain Lambert surfaces; _scattered has their albedo
    LaneMask _smooth = 0;  ///< on smooth interfaces
    InterfaceLanes _interfaces;
    LaneMask _general = 0;  ///< on all others that are not black
    LaneMask _oneSided = 0; ///< on faces that all rays pass from one side
    LaneMask _seen = 0;     ///< of these, on the side that is seen
    const Bsdf* _bsdfs[kLanes] = {};
    Bsdf _textured[kLanes]; ///< where _bsdfs of surfaces that vary point to
    Scattered _scattered;
};

bool storesPhotons(const Bsdf& bsdf)
{
    if (bsdf.diffuse != Vec3(0.0f)) return true;
    return !bsdf.isSmooth() && (bsdf.reflects() || (bsdf.transmits() && bsdf.eta != 1.0f));
}

const Bsdf* ChunkTracer::bsdfAt(const SurfaceLanes& surface, int i)
{
    const MaterialRecord& record = _traced.materials()[surface.material[i]];
    const bool front = (surface.front >> i) & 1u;
    if (record.constant) return front ? &record.front : &record.back;
    const SurfaceRecord& where = _traced.surfaces()[surface.instance[i]];
    const RayBlock& ray = _rays.ray;
    const Vec3 direction(ray.directionX[i], ray.directionY[i], ray.directionZ[i]);
    _textured[i] = _traced.materials().bsdf(
        surface.material[i], materialPointOf(where, record, _rays.primitive[i], _rays.u[i],
                                             _rays.v[i], front, direction));
    return &_textured[i];
}

/// What the lights do not light is passed by, and fixed-function ones fade in their own ways.
void ChunkTracer::leaveLight(PhotonPathBlock& block, SurfaceLanes& surface) const
{
    for (LaneMask lanes = surface.hits; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const Light& light = _lights[block.light[i]];
        if (light.kind != LightKind::Point && light.kind != LightKind::Directional) continue;
        const Material& material = _traced.scene().materials[surface.material[i]];
        if (!isLightEnabled(material, light.number)) surface.hits &= ~(1u << i);
        const float distance =
            isSoft(light)
                ? std::max(light.radius, glm::length(laneOf(surface.position, i) - light.position))
                : _rays.ray.tFar[i];
        const float falloff = _emitter.falloff(block.light[i], distance);
        block.power.x[i] *= falloff;
        block.power.y[i] *= falloff;
        block.power.z[i] *= falloff;
    }
}

void ChunkTracer::store(const PhotonPathBlock& block, const SurfaceLanes& surface, LaneMask lanes,
                        int bounce)
{
    for (; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const Vec3 power = laneOf(block.power, i);
        if (isFinite(power))
            _chunk.photons.push_back({laneOf(surface.position, i), -laneOf(block.direction, i),
                                      power, laneOf(surface.geometricNormal, i),
                                      static_cast<uint32_t>(bounce) + 1, block.direct[i] != 0,
                                      _chunk.bins[block.photon[i] - _first]});
        else
            ++_chunk.dropped;
    }
}

/// Samples the surface model of any lane.
void ChunkTracer::scatterOne(const PhotonPathBlock& block, int i, bool mustMirror)
{
    const Vec3 normal = laneOf(_normal, i), direction = laneOf(block.direction, i);
    Vec3 tangent, bitangent;
    frameOf(normal.x, normal.y, normal.z, tangent, bitangent);
    const Vec3 wo(-glm::dot(direction, tangent), -glm::dot(direction, bitangent),
                  -glm::dot(direction, normal));
    const std::optional<BsdfSample> sample =
        sampleBsdf(*_bsdfs[i], wo, _lobe[i], _u[i], _v[i], Transport::Importance);
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
    const bool mustMirror = mustReflect(bounce);
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
    for (LaneMask lanes = _general; lanes; lanes &= lanes - 1)
        scatterOne(block, __builtin_ctz(lanes), mustMirror);
    _scattered.alive &= ~(_oneSided & ~(_seen ^ _scattered.transmitted));
    const LaneMask alive = leaveSurfaces(surface, _normal, _scattered, _roulette, block);
    _paths.append(block, alive);
}

/// Sorts the lanes by what their surfaces are; returns those that photons are stored at.
LaneMask ChunkTracer::classify(const SurfaceLanes& surface)
{
    const MaterialTable& materials = _traced.materials();
    LaneMask stores = 0;
    _diffuse = _smooth = _general = 0;
    for (LaneMask lanes = surface.hits; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const LaneMask lane = 1u << i;
        const MaterialRecord& record = materials[surface.material[i]];
        if (record.plainDiffuse)
        {
            setLane(_scattered.weight, i, record.front.diffuse);
            if (record.front.diffuse != Vec3(0.0f)) _diffuse |= lane;
            continue;
        }
        const Bsdf* const bsdf = bsdfAt(surface, i);
        if (isSmoothInterface(*bsdf))
        {
            _interfaces.set(i, *bsdf);
            _smooth |= lane;
            continue;
        }
        _bsdfs[i] = bsdf;
        _general |= lane;
        if (storesPhotons(*bsdf)) stores |= lane;
    }
    return stores | _diffuse;
}

/// Half of the photons, twice as bright, go on where a surface is lit and lets light through all
/// the same. Such are all surfaces for photons that come straight from a light without shadows, and
/// for others the faces that all rays pass from one side, where photons meet the side that is seen.
/// A path from the eye meets that side only, so what it scatters to the other has come from there:
/// such photons stay, see scatter(). Returns the lanes that go on.
LaneMask ChunkTracer::passFaces(PhotonPathBlock& block, const SurfaceLanes& surface, LaneMask lanes,
                                int bounce)
{
    LaneMask passed = 0;
    for (lanes &= surface.hits; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const Material& material = *_traced.materials()[surface.material[i]].material;
        const LaneMask lane = 1u << i;
        bool passes = bounce == 0 && !_lights[block.light[i]].castsShadows;
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
        const uint32_t face = hash(surface.instance[i], _rays.primitive[i]);
        if (hash(hash(dimension(bounceNumber(bounce)), block.photon[i]), face) & 0x80000000u)
            passed |= lane;
    }
    _oneSided &= ~passed;
    _seen &= ~passed;
    return passed;
}

void ChunkTracer::findSurfaces(PhotonPathBlock& block, LaneMask active, int bounce,
                               SurfaceLanes& surface)
{
    loadRays(block, _rays);
    _oneSided = _seen = 0;
    for (LaneMask lanes = active;;)
    {
        _traced.intersector().closestHits(_rays, active, Coherence::Incoherent, kPhotonRays);
        _chunk.rays += static_cast<uint64_t>(__builtin_popcount(active));
        surfacesOf(_traced.surfaces(), _rays, active, surface);
        if (!_culls && !(bounce == 0 && _shadowless)) return;
        lanes = passFaces(block, surface, lanes, bounce);
        if (!lanes) break;
        for (LaneMask m = lanes; m; m &= m - 1)
        {
            const int i = __builtin_ctz(m);
            _rays.ray.tNear[i] = std::nextafter(_rays.ray.tFar[i], kInfinity);
        }
        std::fill_n(_rays.ray.tFar.v, kLanes, kInfinity); // the others meet what they met
    }
    std::fill_n(_rays.ray.tNear.v, kLanes, 0.0f);
}

/// Stores the photons of a block at what they meet, and sends them on. The block is a copy: what is
/// appended to the queue may take its place.
void ChunkTracer::follow(PhotonPathBlock block, LaneMask active, int bounce)
{
    SurfaceLanes surface;
    findSurfaces(block, active, bounce, surface);
    if (bounce == 0) leaveLight(block, surface);
    const LaneMask stores = classify(surface) & ~(_oneSided & ~_seen);
    if (bounce > 0) store(block, surface, stores, bounce);
    if (bounce + 2 > _options.maxBounces) return; // the next surface would be too far for any eye
    scatter(block, surface, bounce);
}

void ChunkTracer::emitBlock(uint32_t first, uint32_t count)
{
    PhotonPathBlock block;
    for (int i = 0; i < kLanes; ++i)
    {
        block.photon[i] = first + static_cast<uint32_t>(i);
        block.direct[i] = 1;
    }
    EmissionLanes points;
    photonPoints(block.photon, dimension(EmissionChoice), points.light, points.choice);
    photonPoints(block.photon, dimension(EmissionPosition), points.positionU, points.positionV);
    photonPoints(block.photon, dimension(EmissionDirection), points.directionU, points.directionV);
    StartLanes starts;
    const LaneMask lanes =
        _emitter.emitLanes(points, starts, _photonGuide) & (kAllLanes >> (kLanes - count));
    block.origin = starts.origin;
    block.direction = starts.direction;
    block.light = starts.light;
    const float share = 1.0f / static_cast<float>(_options.photons);
    for (int i = 0; i < kLanes; ++i)
    {
        block.power.x[i] = starts.power.x[i] * share;
        block.power.y[i] = starts.power.y[i] * share;
        block.power.z[i] = starts.power.z[i] * share;
    }
    _paths.append(block, lanes);
    for (LaneMask m = lanes; m; m &= m - 1)
    {
        const int i = __builtin_ctz(m);
        _chunk.bins[block.photon[i] - _first] = starts.bin[i];
    }
}

void ChunkTracer::trace(uint32_t first, uint32_t count)
{
    _first = first;
    _chunk.photons.reserve(2 * count); // more than most passes store of each
    _chunk.bins.assign(count, kInvalid);
    for (uint32_t k = 0; k < count; k += kLanes)
        emitBlock(first + k, std::min<uint32_t>(kLanes, count - k));
    readyRays(_rays);
    for (int bounce = 0; _paths.size() > 0; ++bounce)
    {
        const uint32_t flying = _paths.size();
        _paths.clear();
        for (uint32_t k = 0; k < flying; k += kLanes)
        {
            const uint32_t used = std::min<uint32_t>(kLanes, flying - k);
            follow(_paths[k / kLanes], kAllLanes >> (kLanes - used), bounce);
        }
    }
}

} // namespace

TracedPhotons tracePhotons(const TracedScene& traced, const std::vector<Light>& lights,
                           const PhotonEmitter& emitter, const PhotonPassOptions& options, int pass,
                           const Workers& workers, const PhotonGuide* photonGuide)
{
    TracedPhotons result;
    if (options.use == PhotonUse::None || options.photons == 0 || !emitter.emits()) return result;
    if (options.use == PhotonUse::Caustics && !emitter.hasTargets()) return result;
    if (options.maxBounces < 2) return result; // one edge is direct light

    // Apart from the sequences of pixels, whose seeds are hashed otherwise.
    const uint32_t seed = hash(hash(options.seed, 0x70686f74u), static_cast<uint32_t>(pass));
    const uint32_t count = (options.photons + kChunk - 1) / kChunk;
    const std::vector<Material>& materials = traced.scene().materials;
    const bool culls = std::any_of(materials.begin(), materials.end(),
                                   [](const Material& m) { return m.cullsAllRays; });
    std::vector<Chunk> chunks(count);
    workers.forEach(count,
                    [&](std::size_t c)
                    {
                        const uint32_t first = static_cast<uint32_t>(c) * kChunk;
                        Chunk chunk; // neighbours of the list share cache lines
                        ChunkTracer(traced, lights, emitter, photonGuide, options, seed, culls,
                                    chunk)
                            .trace(first, std::min(kChunk, options.photons - first));
                        chunks[c] = std::move(chunk);
                    });
    result.emitted.assign(emitter.guideBins(), 0u);
    std::vector<std::size_t> begin(count + 1);
    for (std::size_t c = 0; c < count; ++c)
    {
        begin[c + 1] = begin[c] + chunks[c].photons.size();
        result.rays += chunks[c].rays;
        result.dropped += chunks[c].dropped;
        for (const uint32_t bin : chunks[c].bins)
            if (bin != kInvalid) ++result.emitted[bin];
    }
    result.photons.resize(begin[count]);
    workers.forEach(count,
                    [&](std::size_t c)
                    {
                        std::copy(chunks[c].photons.begin(), chunks[c].photons.end(),
                                  result.photons.begin() + static_cast<std::ptrdiff_t>(begin[c]));
                    });
    return result;
}

} // namespace osgRayTrace::engine
