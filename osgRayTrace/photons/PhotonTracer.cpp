// PhotonTracer.cpp - follows photons from the lights to the surfaces they are stored on. Layer:
// photons.
// SPDX-License-Identifier: MIT
//
// The photons of a pass are samples of the light that arrives at surfaces: particle tracing
// [Veach97, app. 4.A; Pharr16, sect. 16.2.1]. For any function W of a place and a direction,
//
//   E[ sum over photons of W(position, wi) power ] = integral of W Li |wi.g| dwi dA
//
// where Li is the radiance along all paths of light that PhotonUse leaves to photons, and g is the
// geometric normal. A look-up sets W to f / (pi radius^2) within a disc, which makes the sum the
// radiance towards the eye [Pharr16, sect. 16.2.2]: PhotonGather.h. The power of a photon is
//
//   power_0     = Le cosTheta / (pmf pdfA pdfW) / N
//   power_{k+1} = power_k weight factor / survival
//   weight      = f |wi.n| / pdfW                            [Veach97, ch. 5: adjoint f]
//   factor      = |wo.n| |wi.g| / (|wo.g| |wi.n|)            [Veach97, sect. 5.3]
//   survival    = min(1, largest component of weight factor)
//
// with N = options.photons, pmf of the light among all lights, pdfA of the origin on the light and
// pdfW of the direction. Directions mix plain and guided emission, and pdfW is the density of the
// mixture: PhotonEmitter.h. Point lights have pi I in place of Le cosTheta / pdfA, directional
// lights pi I in place of Le cosTheta / pdfW. Point lights that fade otherwise than with the square
// of the distance multiply power_0 by falloff at the first surface.
//
// Surfaces are sampled with Transport::Importance; n is the shading normal, for which factor
// corrects. A photon goes on with probability survival (Russian roulette), so it keeps its power as
// far as it can. At a face that is lit and lets light through all the same, half of the photons go
// on and half stay, each with twice its power: ChunkTracer::passFaces. Photons that have children
// through openings, and the children, have the weights of PhotonOpenings besides.
//
// Photons are stored from their second surface on, as direct light is sampled from the eye's side,
// and with the number of their edges, so that a look-up can keep to the bounces that are allowed.
// All random numbers depend on the pass and on the photon's number alone.
#include "osgRayTrace/photons/PhotonTracer.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/photons/ChunkTracer.h"

#include <algorithm>

namespace osgRayTrace::engine
{

/// Stores the photons of a block at the surfaces that they meet, and sends them on. The block is a
/// copy, as photons that go on may be written to its place in the queue.
void ChunkTracer::follow(PhotonPathBlock block, LaneMask active, int bounce)
{
    SurfaceLanes surface;
    const bool media = _inputs.traits.media;
    if (media)
        travel(block, active, bounce, surface);
    else
        findSurfaces(block, active, bounce, surface);
    if (_inputs.traits.attenuation && !media) absorb(block, surface);
    if (bounce == 0) leaveLight(block, surface);
    const LaneMask stores = classify(block, surface) & ~(_oneSided & ~_seen);
    if (_inputs.recordsFlights) recordFlights(block, surface, bounce > 0 ? stores : 0);
    if (bounce > 0 || _collided)
        store(block, surface, bounce > 0 ? stores : stores & _collided, bounce);
    if (!media && bounce + 2 > _inputs.options.maxBounces)
        return; // the next surface would be too far for any eye
    if (_inputs.traits.subsurface) walkBelowSurfaces(block, surface, bounce);
    scatter(block, surface, bounce);
}

/// Emits sixteen photons, of which the first count are wanted, and queues them: power_0.
void ChunkTracer::emitBlock(uint32_t first, uint32_t count)
{
    PhotonPathBlock block;
    for (int i = 0; i < kLanes; ++i)
    {
        block.photon[i] = first + static_cast<uint32_t>(i);
        block.direct[i] = 1;
        block.flight[i] = kInvalid;
    }
    EmissionLanes points;
    photonPoints(block.photon, dimension(EmissionChoice), points.light, points.choice);
    photonPoints(block.photon, dimension(EmissionPosition), points.positionU, points.positionV);
    photonPoints(block.photon, dimension(EmissionDirection), points.directionU, points.directionV);
    StartLanes starts;
    const LaneMask lanes = _inputs.emitter.emitLanes(points, starts, _inputs.photonGuide) &
                           (kAllLanes >> (kLanes - count));
    block.origin = starts.origin;
    block.direction = starts.direction;
    block.light = starts.light;
    if (_inputs.traits.media)
        for (int i = 0; i < kLanes; ++i)
        {
            const bool used = (lanes >> i) & 1u;
            block.bodies[i] = used ? _inputs.emitter.bodiesOf(starts.light[i]).word() : 0;
            block.met[i] = 0;
            block.late[i] = 0;
        }
    const float share = 1.0f / static_cast<float>(_inputs.options.photons);
    for (int i = 0; i < kLanes; ++i)
    {
        block.power.x[i] = starts.power.x[i] * share;
        block.power.y[i] = starts.power.y[i] * share;
        block.power.z[i] = starts.power.z[i] * share;
    }
    if (_inputs.openings) sendFromLights(block, lanes);
    _paths.append(block, lanes);
    for (const int i : lanesIn(lanes))
        _chunk.bins[block.photon[i] - _first] = starts.bin[i];
}

void ChunkTracer::trace(uint32_t first, uint32_t count)
{
    _first = first;
    _chunk.bins.assign(count, kInvalid);
    for (uint32_t k = 0; k < count; k += kLanes)
        emitBlock(first + k, std::min<uint32_t>(kLanes, count - k));
    readyRays(_rays);
    for (int bounce = 0;
         _paths.size() + _sent.size() > 0 && bounce < static_cast<int>(kMostFlights); ++bounce)
    {
        std::swap(_sent, _arriving);
        _sent.clear();
        const uint32_t flying = _paths.size();
        _paths.clear();
        for (const PhotonPathQueue* queue : {&_paths, &_arriving})
        {
            const uint32_t size = queue == &_paths ? flying : queue->size();
            for (uint32_t k = 0; k < size; k += kLanes)
            {
                const uint32_t used = std::min<uint32_t>(kLanes, size - k);
                follow((*queue)[k / kLanes], kAllLanes >> (kLanes - used), bounce);
            }
        }
    }
}

namespace
{

/// Returns how many photons of a pass are followed together: many, which fill the lanes of more
/// blocks, but so few that a pass has work for some tens of threads. The number of threads is left
/// out, as no bit of a picture may depend on it.
uint32_t chunkOf(uint32_t photons)
{
    constexpr uint32_t kLeastChunk = 512, kLeastChunks = 128;
    uint32_t chunk = kPhotonChunk;
    while (chunk > kLeastChunk && photons / chunk < kLeastChunks)
        chunk /= 2;
    return chunk;
}

} // namespace

TracedPhotons tracePhotons(const TracedScene& traced, const std::vector<Light>& lights,
                           const PhotonEmitter& emitter, const PhotonPassOptions& options, int pass,
                           const Workers& workers, PhotonMemory& memory,
                           const PhotonGuide* photonGuide, const PhotonOpenings* openings,
                           bool recordsFlights)
{
    TracedPhotons result;
    if (options.use == PhotonUse::None || options.photons == 0 || !emitter.emits()) return result;
    if (options.use == PhotonUse::Caustics && !emitter.hasTargets()) return result;
    if (options.maxBounces < 2) return result; // one edge is direct light

    // The photons' sequences differ from those of pixels, whose seeds are hashed otherwise.
    const uint32_t seed = hash(hash(options.seed, 0x70686f74u), static_cast<uint32_t>(pass));
    const uint32_t each = chunkOf(options.photons);
    const uint32_t count = (options.photons + each - 1) / each;
    const std::vector<Material>& materials = traced.scene().materials;
    const auto culls = [](const Material& material) { return material.cullsAllRays; };
    const auto isShadowless = [](const Light& light) { return !light.castsShadows; };
    const ChunkInputs inputs{traced,
                             traced.traits(),
                             traced.materials(),
                             lights,
                             emitter,
                             photonGuide,
                             openings,
                             options,
                             recordsFlights,
                             seed,
                             std::any_of(materials.begin(), materials.end(), culls),
                             std::any_of(lights.begin(), lights.end(), isShadowless)};
    std::vector<PhotonChunk> chunks(count);
    workers.forEach(
        count,
        [&](std::size_t c)
        {
            const uint32_t first = static_cast<uint32_t>(c) * each;
            PhotonChunk chunk; // neighbours of the list share cache lines
            chunk.photons = PhotonBlocks(memory);
            ChunkTracer(inputs, chunk).trace(first, std::min(each, options.photons - first));
            chunks[c] = std::move(chunk);
        });
    result.emitted.assign(emitter.guideBins(), 0u);
    result.photons = PhotonBlocks(memory);
    for (PhotonChunk& chunk : chunks)
    {
        result.photons.append(std::move(chunk.photons));
        result.beams.insert(result.beams.end(), chunk.beams.begin(), chunk.beams.end());
        result.points.insert(result.points.end(), chunk.points.begin(), chunk.points.end());
        const auto before = static_cast<uint32_t>(result.flights.size());
        for (PhotonFlight& flight : chunk.flights)
            if (flight.before != kInvalid) flight.before += before;
        result.flights.insert(result.flights.end(), chunk.flights.begin(), chunk.flights.end());
        result.cutWalks += chunk.cutWalks;
        result.openWalks += chunk.openWalks;
        result.rays += chunk.rays;
        result.dropped += chunk.dropped;
        if (result.emitted.empty()) continue;
        for (const uint32_t bin : chunk.bins)
            if (bin != kInvalid) ++result.emitted[bin];
    }
    return result;
}

} // namespace osgRayTrace::engine
