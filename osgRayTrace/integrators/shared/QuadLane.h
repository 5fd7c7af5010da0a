// QuadLane.h - the sample of one lane on a flat light, as vector code. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/SurfaceLanes.h"
#include "osgRayTrace/integrators/shared/LightLanes.h"
#include "osgRayTrace/shading/RectangleLight.h"

#include <cmath>

namespace osgRayTrace::engine
{

/// A parallelogram or triangle that shines.
struct Quad
{
    PlainVec3 corner, edgeU, edgeV, normal;
    float area;
    float offset;      ///< error bound of a point on the light
    uint32_t twoSided; ///< all bits or none
    PlainVec3 radiance;
};

/// A point on a light.
struct QuadPoint
{
    PlainVec3 place;
    float solidAngle; ///< directions to the point are uniform over it [sr]; 0: the place is by area
};

/// Sets the sample of lane i. Returns all bits if the light can reach the surface.
OSGRAYTRACE_INLINE uint32_t quadLane(const Quad& q, float inversePmf, const SurfaceLanes& surface,
                                     int i, uint32_t transmissive, QuadPoint point,
                                     LightLanes& samples)
{
    const PlainVec3 l = point.place;
    const PlainVec3 p = plainOf(surface.position, i), n = plainOf(surface.geometricNormal, i);
    const PlainVec3 lightNormal = q.normal;

    // The signs of height and above tell the point's side of the light, and the light's side of it.
    const PlainVec3 towards = p - l;
    const float height = dot(towards, lightNormal);
    const float lightSide = select(height >= 0.0f, q.offset, -q.offset);
    const float above = -dot(towards, n);
    const float offset = surface.offset[i];
    const float surfaceSide = select(above >= 0.0f, offset, -offset);

    const PlainVec3 origin = p + n * surfaceSide;
    const PlainVec3 d = l + lightNormal * lightSide - origin;
    const float distance = std::sqrt(dot(d, d));
    const float perDistance = 1.0f / distance;

    // The shadow ray is moved off both surfaces. The geometry term is not, or the light of large
    // surfaces would be wrong by their error bound.
    const float inverse = 1.0f / std::sqrt(dot(towards, towards));
    const PlainVec3 wi = -towards * inverse;
    setLane(samples.wi, i, wi);

    const float cosL = -dot(wi, lightNormal);
    const float cosine = select(q.twoSided, std::fabs(cosL), cosL);
    const float byArea = cosine * q.area * inverse * inverse;
    const float weight = select(point.solidAngle > 0.0f, point.solidAngle, byArea);
    samples.weight[i] = weight * inversePmf;
    samples.radiance[0][i] = q.radiance.x;
    samples.radiance[1][i] = q.radiance.y;
    samples.radiance[2][i] = q.radiance.z;
    setRay(samples.shadow, i, origin, d * perDistance, 0.0f, distance);
    const uint32_t reachable = maskOf(above > 0.0f) | transmissive;
    return maskOf(byArea > 0.0f) & maskOf(weight < 1e30f) & reachable;
}

OSGRAYTRACE_INLINE PlainVec3 pointOn(const Quad& q, float u, float v)
{
    return {q.corner.x + u * q.edgeU.x + v * q.edgeV.x, q.corner.y + u * q.edgeU.y + v * q.edgeV.y,
            q.corner.z + u * q.edgeU.z + v * q.edgeV.z};
}

/// Returns all bits if the solid angle of the rectangle may be above least [sr], as seen from p.
/// With h the distance of p from the rectangle's plane and r that of a point of the rectangle, the
/// solid angle is the integral of h / r^3 over the area: at most the area times h over the cube of
/// the least r. The bound is closer than that of mayBeWide: in a room below a lamp it leaves out
/// the floor.
OSGRAYTRACE_INLINE uint32_t mayExceed(const RectangleLight& rectangle, PlainVec3 p, float least)
{
    constexpr float kRounding = 1.001f;
    const PlainVec3 d = p - rectangle.corner;
    const float u = dot(d, rectangle.axisU), v = dot(d, rectangle.axisV);
    const float h = std::fabs(dot(d, rectangle.normal));
    const float pastU = select(u < 0.0f, u, u - rectangle.width);
    const float pastV = select(v < 0.0f, v, v - rectangle.height);
    const float besideU = select(u * pastU > 0.0f, pastU, 0.0f);
    const float besideV = select(v * pastV > 0.0f, pastV, 0.0f);
    const float least2 = besideU * besideU + besideV * besideV + h * h;
    const float most = kRounding * (rectangle.width * rectangle.height) * h;
    return maskOf(most > least * (least2 * std::sqrt(least2)));
}

/// Returns a point on a rectangle, by solid angle if that is wide from p, else by area.
OSGRAYTRACE_INLINE QuadPoint rectanglePoint(const Quad& q, const RectangleLight& rectangle,
                                            PlainVec3 p, float u, float v)
{
    const SphericalRectangle seen = seenFrom(rectangle, p);
    float x, y;
    squareToSphericalRectangle(seen, u, v, x, y);
    const uint32_t wide = isWide(rectangle, seen);
    const float s = select(wide, (x - seen.x0) / rectangle.width, u);
    const float t = select(wide, (y - seen.y0) / rectangle.height, v);
    return {pointOn(q, s, t), select(wide, seen.solidAngle, 0.0f)};
}

} // namespace osgRayTrace::engine
