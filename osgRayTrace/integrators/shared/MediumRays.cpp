// MediumRays.cpp - follows rays through boundaries of media. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/MediumRays.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/media/GridRay.h"
#include "osgRayTrace/media/MediumWay.h"
#include "osgRayTrace/media/Transmittance.h"

#include <cmath>
#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the extinction of the way of lane i from begin to end.
Vec3 leftAlong(const MediumTable& media, MediumStack bodies, const RayBlock& ray, int i,
               float begin, float end)
{
    const MediumId medium = media.at(bodies);
    const MediumRecord& record = media[medium];
    if (record.sigmaT == Vec3(0.0f)) return Vec3(1.0f);
    const Vec3 origin(ray.originX[i], ray.originY[i], ray.originZ[i]);
    const RayPart part = media.clipped(medium, origin, directionOf(ray, i), begin, end);
    if (part.isEmpty()) return Vec3(1.0f);
    const float length = record.thins
                             ? MediumWay(record, origin, directionOf(ray, i), part).length()
                             : part.end - part.begin;
    return transmittance(record.sigmaT, length);
}

void dim(LightLanes& samples, int i, Vec3 share)
{
    for (int c = 0; c < 3; ++c)
        samples.radiance[c][i] *= share[c];
    setLane(samples.tint, i,
            ((samples.tinted >> i) & 1u ? laneOf(samples.tint, i) : Vec3(1.0f)) * share);
    samples.tinted |= 1u << i;
}

/// Returns a seed that depends on a ray and the pass alone.
uint32_t seedOf(const PassContext& context, const RayBlock& ray, int i)
{
    uint32_t seed = hash(context.key.seed, context.key.index);
    for (const float value : {ray.originX[i], ray.originY[i], ray.originZ[i], ray.directionX[i],
                              ray.directionY[i], ray.directionZ[i], ray.tFar[i]})
    {
        uint32_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        seed = hash(seed, bits);
    }
    return seed;
}

void dimByVolumes(const PassContext& context, LaneMask visible, LightLanes& samples)
{
    const RayBlock& ray = samples.shadow;
    for (const int i : lanesIn(visible))
    {
        const Vec3 origin(ray.originX[i], ray.originY[i], ray.originZ[i]);
        const GridRay grids(context.traced->grids(), origin, directionOf(ray, i), ray.tNear[i],
                            ray.tFar[i]);
        if (grids.isEmpty()) continue;
        NumberStream numbers(seedOf(context, ray, i));
        dim(samples, i, grids.transmittance(ray.tNear[i], ray.tFar[i], numbers));
    }
}

} // namespace

void dimByMedia(const PassContext& context, const MediumLanes& bodies, LaneMask visible,
                LightLanes& samples)
{
    const TracedScene& traced = *context.traced;
    const MediumTable& media = traced.media();
    samples.tinted &= context.traced->traits().panes ? kAllLanes : 0u;
    if (traced.traits().volumes) dimByVolumes(context, visible, samples);
    if (!media.hasInterfaces())
    {
        for (const int i : lanesIn(visible))
            dim(samples, i,
                leftAlong(media, bodies[i], samples.shadow, i, samples.shadow.tNear[i],
                          samples.shadow.tFar[i]));
        return;
    }
    RayHitBlock rays;
    rays.ray = samples.shadow;
    MediumLanes within = bodies;
    FloatLanes begin = samples.shadow.tNear;
    LaneMask open = visible;
    for (int k = 0; k < kMostCrossings && open; ++k)
    {
        traced.intersector().closestHits(rays, open, Coherence::Incoherent);
        SurfaceLanes surface;
        surfacesOf(traced.surfaces(), rays, open, surface);
        for (const int i : lanesIn(open))
        {
            const bool hit = (surface.hits >> i) & 1u, front = (surface.front >> i) & 1u;
            const MediumId body = hit ? media.interiorOf(surface.material[i]) : kOutside;
            if (body != kOutside) within[i] = bodiesBefore(within[i], body, front);
            dim(samples, i, leftAlong(media, within[i], rays.ray, i, begin[i], rays.ray.tFar[i]));
            if (body != kOutside) within[i] = bodiesBehind(within[i], body, front);
            begin[i] = rays.ray.tFar[i];
            goOnBehindHit(rays.ray, i, samples.shadow.tFar[i]);
            if (!hit || !(rays.ray.tNear[i] < rays.ray.tFar[i])) open &= ~(1u << i);
        }
    }
}

} // namespace osgRayTrace::engine
