// PhotonTracer.cpp - follows photons from the lights to the surfaces they are stored on. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonTracer.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/sampling/Sampler.h"
#include "osgRayTrace/sampling/Warp.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr uint32_t kChunk = 1024; ///< photons that are followed together

/// Dimensions of a photon's sequence.
enum PhotonDimension : uint32_t
{
    EmissionChoice = 0, ///< light, aim
    EmissionPosition = 1,
    EmissionDirection = 2,
    BounceFirst = 3, ///< then for each bounce: direction; lobe and roulette
};

struct Flight
{
    Vec3 origin, direction, power;
    uint32_t index;  ///< of the photon within the pass
    uint32_t light;
    bool direct = true; ///< nothing but mirror-like surfaces yet
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
    ChunkTracer(const TracedScene& traced, const std::vector<Light>& lights, const PhotonEmitter& emitter,
                const PhotonPassOptions& options, uint32_t passSeed, Chunk& chunk)
        : _traced(traced), _lights(lights), _emitter(emitter), _options(options), _seed(passSeed),
          _chunk(chunk)
    {
    }

    void trace(uint32_t first, uint32_t count);

private:
    Vec2 point(uint32_t photon, uint32_t dimension) const
    {
        Vec2 u;
        sobol2(photon, dimensionSeed(_seed, dimension), u.x, u.y);
        return u;
    }

    void followGroup(const Flight* flights, int count, int bounce, std::vector<Flight>& next);
    void meet(const RayHitBlock& rays, const SurfaceLanes& surface, int i, Flight flight, int bounce,
              std::vector<Flight>& next);
    Bsdf bsdfAt(const RayHitBlock& rays, const SurfaceLanes& surface, int i) const;

    const TracedScene& _traced;
    const std::vector<Light>& _lights;
    const PhotonEmitter& _emitter;
    const PhotonPassOptions& _options;
    uint32_t _seed;
    Chunk& _chunk;
};

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
    MaterialPoint at;
    at.front = front;
    at.uv = interpolateUv(where, rays.primitive[i], rays.u[i], rays.v[i]);
    at.vertexColor = interpolateColor(where, rays.primitive[i], rays.u[i], rays.v[i]);
    return _traced.materials().bsdf(surface.material[i], at);
}

/// Stores the photon of lane i at what it met, and sends it on.
void ChunkTracer::meet(const RayHitBlock& rays, const SurfaceLanes& surface, int i, Flight flight,
                       int bounce, std::vector<Flight>& next)
{
    if (bounce == 0)
    {
        const Light& light = _lights[flight.light];
        const Material& material = _traced.scene().materials[surface.material[i]];
        const bool delta = light.kind == LightKind::Point || light.kind == LightKind::Directional;
        if (delta && light.number < 32 && !((material.lightMask >> light.number) & 1u)) return;
        flight.power *= _emitter.falloff(flight.light, rays.ray.tFar[i]);
    }
    const bool mustReflect = _options.use == PhotonUse::Caustics && bounce == 0;
    const Bsdf bsdf = bsdfAt(rays, surface, i);
    const Vec3 position(surface.position.x[i], surface.position.y[i], surface.position.z[i]);
    const Vec3 geometric(surface.geometricNormal.x[i], surface.geometricNormal.y[i],
                         surface.geometricNormal.z[i]);
    if (bounce > 0 && storesPhotons(bsdf))
    {
        if (isFinite(flight.power))
            _chunk.photons.push_back({position, -flight.direction, flight.power, geometric,
                                      static_cast<uint32_t>(bounce) + 1, flight.direct});
        else
            ++_chunk.dropped;
    }
    if (bounce + 2 > _options.maxBounces) return; // the next surface would be too far for any eye
    if (mustReflect && !(bsdf.isSmooth() && bsdf.reflects()) && !bsdf.transmits()) return;

    Vec3 shading(surface.shadingNormal.x[i], surface.shadingNormal.y[i], surface.shadingNormal.z[i]);
    if (glm::dot(shading, geometric) < 0.0f) shading = -shading;
    if (!(glm::dot(shading, flight.direction) < -1e-4f)) shading = geometric;
    Vec3 tangent, bitangent;
    frameOf(shading.x, shading.y, shading.z, tangent, bitangent);
    const Vec3 wo(-glm::dot(flight.direction, tangent), -glm::dot(flight.direction, bitangent),
                  -glm::dot(flight.direction, shading));
    const uint32_t dimension = BounceFirst + 2 * static_cast<uint32_t>(bounce);
    const Vec2 u = point(flight.index, dimension), lobe = point(flight.index, dimension + 1);
    const std::optional<BsdfSample> sample =
        sampleBsdf(bsdf, wo, lobe.x, u.x, u.y, Transport::Importance);
    if (!sample || (mustReflect && !sample->delta)) return;
    const Vec3 wi = tangent * sample->wi.x + bitangent * sample->wi.y + shading * sample->wi.z;
    const float side = glm::dot(wi, geometric);
    if ((side < 0.0f) != sample->transmitted) return;

    // Light carries the other cosine than radiance where normals are interpolated [Veach97, sect. 5.3].
    const float correction = (std::fabs(wo.z) * std::fabs(side)) /
                             (std::fabs(glm::dot(flight.direction, geometric)) * std::fabs(sample->wi.z));
    Vec3 weight = sample->weight;
    if (correction < kInfinity) weight *= correction;
    // Survivors keep their power as far as they can.
    const float survival = std::min(1.0f, std::max(weight.x, std::max(weight.y, weight.z)));
    if (!(lobe.y < survival)) return;
    flight.power *= weight / survival;
    flight.origin = position + geometric * (side < 0.0f ? -surface.offset[i] : surface.offset[i]);
    flight.direction = wi;
    flight.direct = flight.direct && sample->delta;
    next.push_back(flight);
}

void ChunkTracer::followGroup(const Flight* flights, int count, int bounce, std::vector<Flight>& next)
{
    RayHitBlock rays;
    for (int i = 0; i < kLanes; ++i)
    {
        const Flight& f = flights[std::min(i, count - 1)];
        rays.ray.originX[i] = f.origin.x;
        rays.ray.originY[i] = f.origin.y;
        rays.ray.originZ[i] = f.origin.z;
        rays.ray.directionX[i] = f.direction.x;
        rays.ray.directionY[i] = f.direction.y;
        rays.ray.directionZ[i] = f.direction.z;
        rays.ray.tNear[i] = 0.0f;
        rays.ray.tFar[i] = kInfinity;
        rays.ray.time[i] = 0.0f;
        rays.ray.mask[i] = 0xffffffffu;
        rays.ray.id[i] = 0;
        rays.ray.flags[i] = 0;
    }
    const LaneMask active = count >= kLanes ? kAllLanes : (1u << count) - 1u;
    _traced.intersector().closestHits(rays, active, Coherence::Incoherent);
    _chunk.rays += static_cast<uint64_t>(count);
    SurfaceLanes surface;
    surfacesOf(_traced.surfaces(), rays, active, surface);
    for (LaneMask lanes = surface.hits; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        meet(rays, surface, i, flights[i], bounce, next);
    }
}

void ChunkTracer::trace(uint32_t first, uint32_t count)
{
    std::vector<Flight> flights, next;
    flights.reserve(count);
    next.reserve(count);
    const float share = 1.0f / static_cast<float>(_options.photons);
    for (uint32_t k = first; k < first + count; ++k)
    {
        const Vec2 choice = point(k, EmissionChoice);
        const std::optional<PhotonStart> start = _emitter.emit(
            {choice.x, choice.y, point(k, EmissionPosition), point(k, EmissionDirection)});
        if (start) flights.push_back({start->origin, start->direction, start->power * share, k, start->light});
    }
    for (int bounce = 0; !flights.empty(); ++bounce)
    {
        next.clear();
        for (std::size_t at = 0; at < flights.size(); at += kLanes)
            followGroup(&flights[at], static_cast<int>(std::min<std::size_t>(kLanes, flights.size() - at)),
                        bounce, next);
        flights.swap(next);
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
