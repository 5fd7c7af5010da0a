// PhotonTracer.cpp - follows photons from the lights to the surfaces they are stored on. Layer:
// photons. SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonTracer.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/photons/PhotonFlights.h"
#include "osgRayTrace/sampling/Sampler.h"
#include "osgRayTrace/sampling/Warp.h"

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
    EmissionChoice = 0, ///< light, aim
    EmissionPosition = 1,
    EmissionDirection = 2,
    BounceFirst = 3, ///< then for each bounce: direction; lobe and roulette
};

struct Chunk
{
    std::vector<Photon> photons;
    uint64_t rays = 0;
    uint64_t dropped = 0;
};

class ChunkTracer
{
public:
    ChunkTracer(const TracedScene& traced, const std::vector<Light>& lights,
                const PhotonEmitter& emitter, const PhotonPassOptions& options, uint32_t passSeed,
                Chunk& chunk)
        : _traced(traced),
          _lights(lights),
          _emitter(emitter),
          _options(options),
          _seed(passSeed),
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
    void follow(FlightBlock block, LaneMask active, int bounce);
    void leaveLight(FlightBlock& block, SurfaceLanes& surface) const;
    void store(const FlightBlock& block, const SurfaceLanes& surface, LaneMask lanes, int bounce);
    void scatterDiffuseLanes(const FlightBlock& block, const SurfaceLanes& surface, LaneMask lanes);
    void scatter(const Bsdf& bsdf, Flight flight, const SurfaceLanes& surface, int i, int bounce);
    Bsdf bsdfAt(const RayHitBlock& rays, const SurfaceLanes& surface, int i) const;

    const TracedScene& _traced;
    const std::vector<Light>& _lights;
    const PhotonEmitter& _emitter;
    const PhotonPassOptions& _options;
    uint32_t _seed;
    Chunk& _chunk;
    FlightQueue _flights{kChunk};
    // Of the block at work.
    FloatLanes _u, _v, _lobe, _roulette; ///< of its bounce
    Vec3Lanes _albedo;                   ///< of lanes that are plain Lambert surfaces
    Bsdf _bsdfs[kLanes];                 ///< of the others
    RayHitBlock _rays;
};

Vec3 laneOf(const Vec3Lanes& lanes, int i)
{
    return Vec3(lanes.x[i], lanes.y[i], lanes.z[i]);
}

Flight flightOf(const FlightBlock& block, int i)
{
    Flight flight;
    flight.origin = laneOf(block.origin, i);
    flight.direction = laneOf(block.direction, i);
    flight.power = laneOf(block.power, i);
    flight.photon = block.photon[i];
    flight.light = block.light[i];
    flight.direct = block.direct[i] != 0;
    return flight;
}

bool storesPhotons(const Bsdf& bsdf)
{
    if (bsdf.diffuse != Vec3(0.0f)) return true;
    return !bsdf.isSmooth() && (bsdf.reflects() || (bsdf.transmits() && bsdf.eta != 1.0f));
}

Bsdf ChunkTracer::bsdfAt(const RayHitBlock& rays, const SurfaceLanes& surface, int i) const
{
    const MaterialRecord& record = _traced.materials()[surface.material[i]];
    const bool front = (surface.front >> i) & 1u;
    if (record.constant) return front ? record.front : record.back;
    const SurfaceRecord& where = _traced.surfaces()[surface.instance[i]];
    const Vec3 direction(rays.ray.directionX[i], rays.ray.directionY[i], rays.ray.directionZ[i]);
    return _traced.materials().bsdf(surface.material[i],
                                    materialPointOf(where, record, rays.primitive[i], rays.u[i],
                                                    rays.v[i], front, direction));
}

/// What the lights do not light is passed by, and fixed-function ones fade in their own ways.
void ChunkTracer::leaveLight(FlightBlock& block, SurfaceLanes& surface) const
{
    for (LaneMask lanes = surface.hits; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const Light& light = _lights[block.light[i]];
        if (light.kind != LightKind::Point && light.kind != LightKind::Directional) continue;
        const Material& material = _traced.scene().materials[surface.material[i]];
        if (light.number < 32 && !((material.lightMask >> light.number) & 1u))
            surface.hits &= ~(1u << i);
        const float falloff = _emitter.falloff(block.light[i], _rays.ray.tFar[i]);
        block.power.x[i] *= falloff;
        block.power.y[i] *= falloff;
        block.power.z[i] *= falloff;
    }
}

void ChunkTracer::store(const FlightBlock& block, const SurfaceLanes& surface, LaneMask lanes,
                        int bounce)
{
    for (; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const Vec3 power = laneOf(block.power, i);
        if (isFinite(power))
            _chunk.photons.push_back({laneOf(surface.position, i), -laneOf(block.direction, i),
                                      power, laneOf(surface.geometricNormal, i),
                                      static_cast<uint32_t>(bounce) + 1, block.direct[i] != 0});
        else
            ++_chunk.dropped;
    }
}

void ChunkTracer::scatterDiffuseLanes(const FlightBlock& block, const SurfaceLanes& surface,
                                      LaneMask lanes)
{
    DiffuseFlights scattered;
    scatterDiffuse(block, surface, _albedo, _u, _v, _roulette, scattered);
    for (lanes &= scattered.alive; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        _flights.append({laneOf(scattered.origin, i), laneOf(scattered.direction, i),
                         laneOf(scattered.power, i), block.photon[i], block.light[i], false});
    }
}

/// Sends the photon of lane i on from any surface.
void ChunkTracer::scatter(const Bsdf& bsdf, Flight flight, const SurfaceLanes& surface, int i,
                          int bounce)
{
    if (mustReflect(bounce) && !(bsdf.isSmooth() && bsdf.reflects()) && !bsdf.transmits()) return;
    const Vec3 position = laneOf(surface.position, i),
               geometric = laneOf(surface.geometricNormal, i);
    Vec3 shading = laneOf(surface.shadingNormal, i);
    if (glm::dot(shading, geometric) < 0.0f) shading = -shading;
    if (!(glm::dot(shading, flight.direction) < -1e-4f)) shading = geometric;
    Vec3 tangent, bitangent;
    frameOf(shading.x, shading.y, shading.z, tangent, bitangent);
    const Vec3 wo(-glm::dot(flight.direction, tangent), -glm::dot(flight.direction, bitangent),
                  -glm::dot(flight.direction, shading));
    const std::optional<BsdfSample> sample =
        sampleBsdf(bsdf, wo, _lobe[i], _u[i], _v[i], Transport::Importance);
    if (!sample || (mustReflect(bounce) && !sample->delta)) return;
    const Vec3 wi = tangent * sample->wi.x + bitangent * sample->wi.y + shading * sample->wi.z;
    const float side = glm::dot(wi, geometric);
    if ((side < 0.0f) != sample->transmitted) return;

    // As in scatterDiffuse.
    const float correction =
        (std::fabs(wo.z) * std::fabs(side)) /
        (std::fabs(glm::dot(flight.direction, geometric)) * std::fabs(sample->wi.z));
    Vec3 weight = sample->weight;
    if (correction < kInfinity) weight *= correction;
    const float survival = std::min(1.0f, std::max(weight.x, std::max(weight.y, weight.z)));
    if (!(_roulette[i] < survival)) return;
    flight.power *= weight / survival;
    flight.origin = position + geometric * (side < 0.0f ? -surface.offset[i] : surface.offset[i]);
    flight.direction = wi;
    flight.direct = flight.direct && sample->delta;
    _flights.append(flight);
}

/// Stores the photons of a block at what they meet, and sends them on. The block is a copy: what is
/// appended to the queue may take its place.
void ChunkTracer::follow(FlightBlock block, LaneMask active, int bounce)
{
    loadRays(block, _rays);
    _traced.intersector().closestHits(_rays, active, Coherence::Incoherent);
    _chunk.rays += static_cast<uint64_t>(__builtin_popcount(active));
    SurfaceLanes surface;
    surfacesOf(_traced.surfaces(), _rays, active, surface);
    if (bounce == 0) leaveLight(block, surface);

    const MaterialTable& materials = _traced.materials();
    LaneMask diffuse = 0, general = 0, stores = 0;
    for (LaneMask lanes = surface.hits; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const MaterialRecord& record = materials[surface.material[i]];
        if (record.plainDiffuse)
        {
            const Vec3 albedo = record.front.diffuse;
            _albedo.x[i] = albedo.x;
            _albedo.y[i] = albedo.y;
            _albedo.z[i] = albedo.z;
            if (albedo != Vec3(0.0f)) diffuse |= 1u << i;
            continue;
        }
        _bsdfs[i] = bsdfAt(_rays, surface, i);
        general |= 1u << i;
        if (storesPhotons(_bsdfs[i])) stores |= 1u << i;
    }
    if (bounce > 0) store(block, surface, stores | diffuse, bounce);
    if (bounce + 2 > _options.maxBounces) return; // the next surface would be too far for any eye
    if (mustReflect(bounce)) diffuse = 0;
    if (!(diffuse | general)) return;
    photonPoints(block.photon, dimension(bounceNumber(bounce)), _u, _v);
    photonPoints(block.photon, dimension(bounceNumber(bounce) + 1), _lobe, _roulette);
    if (diffuse) scatterDiffuseLanes(block, surface, diffuse);
    for (; general; general &= general - 1)
    {
        const int i = __builtin_ctz(general);
        scatter(_bsdfs[i], flightOf(block, i), surface, i, bounce);
    }
}

void ChunkTracer::emitBlock(uint32_t first, uint32_t count)
{
    UintLanes photon;
    for (int i = 0; i < kLanes; ++i)
        photon[i] = first + static_cast<uint32_t>(i);
    EmissionLanes points;
    photonPoints(photon, dimension(EmissionChoice), points.light, points.aim);
    photonPoints(photon, dimension(EmissionPosition), points.positionU, points.positionV);
    photonPoints(photon, dimension(EmissionDirection), points.directionU, points.directionV);
    StartLanes starts;
    const float share = 1.0f / static_cast<float>(_options.photons);
    for (LaneMask lanes = _emitter.emitLanes(points, starts) & (kAllLanes >> (kLanes - count));
         lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        _flights.append({laneOf(starts.origin, i), laneOf(starts.direction, i),
                         laneOf(starts.power, i) * share, photon[i], starts.light[i]});
    }
}

void ChunkTracer::trace(uint32_t first, uint32_t count)
{
    _chunk.photons.reserve(count);
    for (uint32_t k = 0; k < count; k += kLanes)
        emitBlock(first + k, std::min<uint32_t>(kLanes, count - k));
    readyRays(_rays);
    for (int bounce = 0; _flights.size() > 0; ++bounce)
    {
        const uint32_t flying = _flights.size();
        _flights.clear();
        for (uint32_t k = 0; k < flying; k += kLanes)
        {
            const uint32_t used = std::min<uint32_t>(kLanes, flying - k);
            follow(_flights[k / kLanes], kAllLanes >> (kLanes - used), bounce);
        }
    }
}

} // namespace

TracedPhotons tracePhotons(const TracedScene& traced, const std::vector<Light>& lights,
                           const PhotonEmitter& emitter, const PhotonPassOptions& options, int pass,
                           const Workers& workers)
{
    TracedPhotons result;
    if (options.use == PhotonUse::None || options.photons == 0 || !emitter.emits()) return result;
    if (options.use == PhotonUse::Caustics && !emitter.hasTargets()) return result;
    if (options.maxBounces < 2) return result; // one edge is direct light

    // Apart from the sequences of pixels, whose seeds are hashed otherwise.
    const uint32_t seed = hash(hash(options.seed, 0x70686f74u), static_cast<uint32_t>(pass));
    const uint32_t count = (options.photons + kChunk - 1) / kChunk;
    std::vector<Chunk> chunks(count);
    workers.forEach(count,
                    [&](std::size_t c)
                    {
                        const uint32_t first = static_cast<uint32_t>(c) * kChunk;
                        ChunkTracer(traced, lights, emitter, options, seed, chunks[c])
                            .trace(first, std::min(kChunk, options.photons - first));
                    });
    std::vector<std::size_t> begin(count + 1);
    for (std::size_t c = 0; c < count; ++c)
    {
        begin[c + 1] = begin[c] + chunks[c].photons.size();
        result.rays += chunks[c].rays;
        result.dropped += chunks[c].dropped;
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
