// Bodies.h - the bodies that a point or a ray is in, and how rays go through their surfaces. Layer:
// accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/media/MediumTable.h"
#include "osgRayTrace/shading/Bsdf.h"

#include <cmath>

namespace osgRayTrace::engine
{

/// The bodies in which the rays of a block begin.
using MediumLanes = Lanes<MediumStack>;

/// The number of surfaces that a ray is followed through; it sees nothing behind the last one.
constexpr int kMostCrossings = 256;

/// Returns the bodies in which a point is, found by a ray from there through the scene. Bodies that
/// are open may be found or not.
MediumStack bodiesAround(const TracedScene& traced, Vec3 point);

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

/// Makes a ray go on behind its hit, as if nothing were there. A ray may begin on the surface: what
/// follows zero is denormal, which counts as zero while denormals are flushed, and the ray would
/// meet the surface for ever.
inline void goOnBehindHit(RayBlock& ray, int i, float tFar)
{
    constexpr float kLeast = 1e-30f;
    const float behind = std::nextafter(std::nextafter(ray.tFar[i], kInfinity), kInfinity);
    ray.tNear[i] = behind > kLeast ? behind : kLeast;
    ray.tFar[i] = tFar;
}

} // namespace osgRayTrace::engine
