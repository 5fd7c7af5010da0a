// SkyFlights.cpp - sends rays from what a view sees. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/SkyFlights.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/integrators/shared/CameraLanes.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/sampling/Hash.h"
#include "osgRayTrace/sampling/Sobol.h"
#include "osgRayTrace/sampling/Warp.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Sets what the rays of a block met. Panes are no surfaces that light ends at.
void setSeen(const PassContext& context, const RayHitBlock& rays, LaneMask active, SeenBlock& block)
{
    surfacesOf(context.traced->surfaces(), rays, active, block.surface);
    facingNormalLanes(rays.ray, block.surface, block.normal);
    const MaterialTable& materials = context.traced->materials();
    for (const int i : lanesIn(block.surface.hits))
        if (!materials[block.surface.material[i]].pane) block.lanes |= 1u << i;
}

/// Returns a direction that a Lambert surface sends a ray to.
Vec3 lambertDirection(const SeenBlock& block, int i, uint32_t number, std::size_t b)
{
    float u, v;
    sobol2(number, hash(kFlightSeed, static_cast<uint32_t>(b) * kLanes + static_cast<uint32_t>(i)),
           u, v);
    const PlainVec3 local = squareToCosineHemispherePlain(u, v);
    return ShadingFrame(laneOf(block.normal, i)).toWorld(Vec3(local.x, local.y, local.z));
}

} // namespace

Seen lookAround(const PassContext& context, TileCounts& counts)
{
    Seen seen;
    const Intersector& intersector = context.traced->intersector();
    const int across = tilesAlong(context.width), tiles = across * tilesAlong(context.height);
    const int64_t all = int64_t(tiles) * kTileBlocks;
    const auto count = static_cast<std::size_t>(std::min<int64_t>(all, kFlightBlocks / 2));
    seen.blocks.resize(2 * count);
    for (std::size_t k = 0; k < count; ++k)
    {
        // One block of each stretch of the image, by chance.
        const auto stretch = static_cast<int64_t>(k), stretches = static_cast<int64_t>(count);
        const int64_t first = all * stretch / stretches, last = all * (stretch + 1) / stretches;
        const int64_t at = first + hash(kFlightSeed, static_cast<uint32_t>(k)) % (last - first);
        const auto tile = static_cast<int>(at / kTileBlocks);
        RayHitBlock rays;
        centreRayLanes(context.camera, tile % across * kTileSize, tile / across * kTileSize,
                       static_cast<int>(at % kTileBlocks), rays);
        intersector.closestHits(rays, kAllLanes, Coherence::Coherent, kCameraRays);
        counts.cameraRays += kLanes;
        SeenBlock& block = seen.blocks[k];
        setSeen(context, rays, kAllLanes, block);
        RayHitBlock further;
        for (const int i : lanesIn(block.lanes))
        {
            const Vec3 wi = lambertDirection(block, i, kFlightRounds, k);
            setRay(further.ray, i, leave(block.surface, i, wi), wi, kInfinity);
        }
        intersector.closestHits(further, block.lanes, Coherence::Incoherent);
        counts.secondaryRays += static_cast<uint64_t>(countLanes(block.lanes));
        setSeen(context, further, block.lanes, seen.blocks[count + k]);
    }
    setBounds(context.eye, seen);
    return seen;
}

void setBounds(Vec3 eye, Seen& seen)
{
    seen.low = seen.high = eye;
    for (const SeenBlock& block : seen.blocks)
        for (const int i : lanesIn(block.lanes))
        {
            seen.low = glm::min(seen.low, laneOf(block.surface.position, i));
            seen.high = glm::max(seen.high, laneOf(block.surface.position, i));
        }
}

void addFlights(const PassContext& context, const SeenBlock& seen, int block, LightLanes& samples,
                TileCounts& counts, std::vector<Flight>& flights)
{
    samples.tinted = 0;
    const LaneMask visible = visibleLanes(context, samples, counts);
    for (const int i : lanesIn(visible))
        flights.push_back({laneOf(seen.surface.position, i), laneOf(samples.wi, i), block, i});
}

void setFlight(const SeenBlock& seen, int i, Vec3 wi, LightLanes& samples)
{
    if (!(glm::dot(wi, laneOf(seen.surface.geometricNormal, i)) > 0.0f)) return;
    setSample(samples, i, wi, Vec3(1.0f), 1.0f);
    setRay(samples.shadow, i, leave(seen.surface, i, wi), wi, kInfinity);
    samples.lit |= 1u << i;
}

void sendAround(const PassContext& context, Seen& seen, int first, int last, TileCounts& counts,
                std::vector<Flight>& flights)
{
    for (int round = first; round < last; ++round)
        for (std::size_t b = 0; b < seen.blocks.size(); ++b)
        {
            SeenBlock& block = seen.blocks[b];
            LightLanes samples;
            for (const int i : lanesIn(block.lanes))
                setFlight(block, i, lambertDirection(block, i, static_cast<uint32_t>(round), b),
                          samples);
            for (const int i : lanesIn(samples.lit))
                ++block.sent[i];
            addFlights(context, block, static_cast<int>(b), samples, counts, flights);
        }
}

} // namespace osgRayTrace::engine
