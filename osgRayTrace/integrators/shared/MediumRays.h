// MediumRays.h - what bodies a point is in, and what media leave of shadow rays. Layer:
// integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/LightLanes.h"
#include "osgRayTrace/media/MediumTable.h"

namespace osgRayTrace::engine
{

/// The bodies in which the rays of a block begin.
using MediumLanes = Lanes<MediumStack>;

/// Returns the bodies in which a point is, found by a ray from there through the scene. Bodies that
/// are open may be found or not.
MediumStack bodiesAround(const PassContext& context, Vec3 point);

/// Returns the stack of a ray before it met the surface of a body. A ray that meets the inner side
/// of a body has been in the body, whether the stack knows of it or not.
inline MediumStack bodiesBefore(MediumStack bodies, MediumId body, bool front)
{
    return front || bodies.has(body) ? bodies : bodies.begunIn(body);
}

/// Returns the stack of a ray that has gone through the surface of a body.
inline MediumStack bodiesBehind(MediumStack bodies, MediumId body, bool front)
{
    return front ? bodies.entered(body) : bodies.left(body);
}

/// Sets the index of a surface with which a ray's body meets the next one, if bodies have
/// priorities: see MediumTable::nests.
inline void setRelativeIor(const MediumTable& media, MediumStack bodies, MediumId body, bool front,
                           Bsdf& bsdf)
{
    if (!media.nests() || body == kOutside || !bsdf.transmits() || bsdf.layered) return;
    const MediumId behind = media.at(bodiesBehind(bodies, body, front));
    bsdf.eta = media[behind].ior / media[media.at(bodies)].ior;
}

/// Makes a ray go on behind its hit, as if nothing were there.
inline void goOnBehindHit(RayBlock& ray, int i, float tFar)
{
    ray.tNear[i] = std::nextafter(std::nextafter(ray.tFar[i], kInfinity), kInfinity);
    ray.tFar[i] = tFar;
}

/// Multiplies the radiance of visible samples by what media leave on the ways of their shadow rays:
/// exp(-sum of sigmaT length) over the stretches between the boundaries that do not block, and an
/// estimate of it for volumes. The scene has SceneTraits::media.
void dimByMedia(const PassContext& context, const MediumLanes& bodies, LaneMask visible,
                LightLanes& samples);

} // namespace osgRayTrace::engine
