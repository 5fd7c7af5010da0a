// Bodies.cpp - finds the bodies that a point is in. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/Bodies.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/Surface.h"

namespace osgRayTrace::engine
{

MediumStack bodiesAround(const TracedScene& traced, Vec3 point)
{
    // A direction that no model is built along.
    const Vec3 direction = glm::normalize(Vec3(0.3141f, 0.2718f, 0.9097f));
    RayHitBlock rays;
    setRay(rays.ray, 0, plainOf(point), plainOf(direction), 0.0f, kInfinity);
    HitRule everything;
    everything.solid = true;
    MediumStack begun, inside;
    for (int k = 0; k < kMostCrossings; ++k)
    {
        traced.intersector().closestHits(rays, 1u, Coherence::Incoherent, everything);
        SurfaceLanes surface;
        surfacesOf(traced.surfaces(), rays, 1u, surface);
        if (!surface.hits) break;
        const MediumId body = traced.media().interiorOf(surface.material[0]);
        goOnBehindHit(rays.ray, 0, kInfinity);
        if (body == kOutside) continue;
        const bool front = surface.front & 1u;
        if (!front && !inside.has(body)) begun = begun.begunIn(body);
        inside = bodiesBehind(inside, body, front);
    }
    return begun;
}

} // namespace osgRayTrace::engine
