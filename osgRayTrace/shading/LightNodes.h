// LightNodes.h - bounds of emitters and nodes of a light tree, for loops over lanes. Layer:
// shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/LightEmitters.h"

namespace osgRayTrace::engine
{

/// The half-angles of a cone and of what is near it are taken so much larger, against rounding.
constexpr float kConeSlack = 1e-5f;

/// Ranges are taken so many times, against rounding.
constexpr float kReachSlack = 1.00001f;

constexpr float kAllDirections = -1.0f; ///< the cosine of a cone that holds all directions

/// LightBounds for loops over lanes.
struct PlainBounds
{
    PlainVec3 low, high;
    PlainVec3 axis;
    float cosCone, cosEmission;
    float intensity; ///< negative if some of the lights shine to both sides
    PlainVec3 falloff;
    float range;
};

OSGRAYTRACE_INLINE PlainBounds plainOf(const LightBounds& b)
{
    return {plainOf(b.low),     plainOf(b.high), plainOf(b.axis),
            b.cosCone,          b.cosEmission,   b.twoSided ? -b.intensity : b.intensity,
            plainOf(b.falloff), b.range};
}

OSGRAYTRACE_INLINE PlainVec3 least(PlainVec3 a, PlainVec3 b)
{
    return {least(a.x, b.x), least(a.y, b.y), least(a.z, b.z)};
}

OSGRAYTRACE_INLINE PlainVec3 largest(PlainVec3 a, PlainVec3 b)
{
    return {largest(a.x, b.x), largest(a.y, b.y), largest(a.z, b.z)};
}

OSGRAYTRACE_INLINE PlainBounds select(uint32_t mask, const PlainBounds& a, const PlainBounds& b)
{
    return {select(mask, a.low, b.low),
            select(mask, a.high, b.high),
            select(mask, a.axis, b.axis),
            select(mask, a.cosCone, b.cosCone),
            select(mask, a.cosEmission, b.cosEmission),
            select(mask, a.intensity, b.intensity),
            select(mask, a.falloff, b.falloff),
            select(mask, a.range, b.range)};
}

/// A cone of directions.
struct LightCone
{
    PlainVec3 axis;
    float cosine;
};

/// Returns the smallest cone around two [Conty18, alg. 1], without a trigonometric function.
OSGRAYTRACE_INLINE LightCone coneAround(const LightCone& first, const LightCone& second)
{
    const uint32_t swapped = maskOf(second.cosine < first.cosine); // a is the wider one
    const LightCone a{select(swapped, second.axis, first.axis),
                      select(swapped, second.cosine, first.cosine)};
    const LightCone b{select(swapped, first.axis, second.axis),
                      select(swapped, first.cosine, second.cosine)};
    const float cosBetween = largest(least(dot(a.axis, b.axis), 1.0f), -1.0f);
    const float sinBetween = sineOf(cosBetween), sinA = sineOf(a.cosine), sinB = sineOf(b.cosine);
    // The angle from a's axis to the far side of b is between + b.
    const float cosFar = cosBetween * b.cosine - sinBetween * sinB;
    const float sinFar = sinBetween * b.cosine + cosBetween * sinB;
    // The axis turns by t = (between + b - a) / 2 towards b's.
    const float cosTwice = cosFar * a.cosine + sinFar * sinA;
    const float sinTwice = sinFar * a.cosine - cosFar * sinA;
    const float sinTurn = std::sqrt(largest(0.0f, 0.5f - 0.5f * cosTwice));
    const float halfCosine = std::sqrt(largest(0.0f, 0.5f + 0.5f * cosTwice));
    const float cosTurn = select(sinTwice < 0.0f, -halfCosine, halfCosine);
    const float sinAll = sinTurn * a.cosine + cosTurn * sinA;
    const float cosAll = cosTurn * a.cosine - sinTurn * sinA;
    // Axes that are nearly parallel have no direction to turn to.
    const uint32_t apart = maskOf(sinBetween > 1e-4f), cone = maskOf(sinAll > 0.0f);
    const PlainVec3 across =
        (b.axis - a.axis * cosBetween) * (1.0f / select(apart, sinBetween, 1.0f));
    const PlainVec3 turned = a.axis * cosTurn + across * sinTurn;
    const float length = std::sqrt(dot(turned, turned));
    const uint32_t turns = apart & cone;
    const float wide = select(cone & maskOf(cosBetween > 0.0f), least(cosAll, cosFar), -1.0f);
    const float around = select(turns, largest(cosAll - kConeSlack, kAllDirections), wide);

    const uint32_t all = maskOf(a.cosine <= kAllDirections);
    const uint32_t within = maskOf(sinFar >= 0.0f) & maskOf(cosFar >= a.cosine);
    const PlainVec3 axis = turned * (1.0f / select(turns, length, 1.0f));
    return {select(turns & ~(all | within), axis, a.axis), select(all | within, a.cosine, around)};
}

/// Returns what joined() returns.
OSGRAYTRACE_INLINE PlainBounds joinedBounds(const PlainBounds& a, const PlainBounds& b)
{
    const float powerA = std::fabs(a.intensity), powerB = std::fabs(b.intensity);
    const uint32_t twoSidedA = maskOf(a.intensity < 0.0f), twoSidedB = maskOf(b.intensity < 0.0f);
    // The normals of lights that shine to both sides may be taken either way.
    const uint32_t turned = twoSidedA & twoSidedB & maskOf(dot(a.axis, b.axis) < 0.0f);
    const LightCone cone = coneAround(LightCone{a.axis, a.cosCone},
                                      LightCone{select(turned, -b.axis, b.axis), b.cosCone});
    const float power = powerA + powerB;
    const float share = powerB / select(power > 0.0f, power, 1.0f);
    const PlainBounds both{least(a.low, b.low),
                           largest(a.high, b.high),
                           cone.axis,
                           cone.cosine,
                           least(a.cosEmission, b.cosEmission),
                           select(twoSidedA | twoSidedB, -power, power),
                           a.falloff + (b.falloff - a.falloff) * share,
                           largest(a.range, b.range)};
    const PlainBounds second = select(maskOf(powerA > 0.0f), both, b);
    return select(maskOf(powerB > 0.0f), second, a);
}

/// Returns the centre of a box.
OSGRAYTRACE_INLINE PlainVec3 centreOf(const PlainBounds& b)
{
    return (b.low + b.high) * 0.5f;
}

/// Returns the radius of the sphere around a box with this centre.
OSGRAYTRACE_INLINE float radiusAround(PlainVec3 centre, const PlainBounds& b)
{
    const PlainVec3 half = largest(b.high - centre, centre - b.low);
    return std::sqrt(dot(half, half));
}

constexpr float kMostExtent = 1023.0f; ///< of ten bits

/// Returns a half extent in steps of ten bits, rounded up.
OSGRAYTRACE_INLINE uint32_t extentBits(float extent, float perStep)
{
    const float steps = least(extent * perStep + 1.0f, kMostExtent);
    return static_cast<uint32_t>(static_cast<int32_t>(steps));
}

/// Returns the half extents of a box as ten bits each, in steps of the half diagonal over 1023.
OSGRAYTRACE_INLINE uint32_t packedExtents(const PlainBounds& b, float halfDiagonal)
{
    const float perStep = kMostExtent / select(halfDiagonal > 0.0f, halfDiagonal, 1.0f);
    const PlainVec3 half = (b.high - b.low) * 0.5f;
    return extentBits(half.x, perStep) | (extentBits(half.y, perStep) << 10) |
           (extentBits(half.z, perStep) << 20);
}

/// Returns what boundsOf() returns for a parallelogram or a triangle.
OSGRAYTRACE_INLINE PlainBounds areaBounds(const LightEmitter& emitter)
{
    const PlainVec3 corner{emitter.corner[0], emitter.corner[1], emitter.corner[2]};
    const PlainVec3 u{emitter.edgeU[0], emitter.edgeU[1], emitter.edgeU[2]};
    const PlainVec3 v{emitter.edgeV[0], emitter.edgeV[1], emitter.edgeV[2]};
    const uint32_t triangle = maskOf((emitter.flags & kTriangle) != 0);
    const PlainVec3 besideU = corner + u, besideV = corner + v;
    const PlainVec3 far = select(triangle, besideU, besideU + v);
    const PlainVec3 perpendicular = cross(u, v);
    const float length = std::sqrt(dot(perpendicular, perpendicular));
    const uint32_t plane = maskOf(length > 1e-30f) & maskOf(length < 1e30f);
    const float scale = 1.0f / select(plane, length, 1.0f);
    const float power =
        luminanceOf(emitter.radiance[0], emitter.radiance[1], emitter.radiance[2]) * emitter.area;
    return {least(least(corner, besideU), least(besideV, far)),
            largest(largest(corner, besideU), largest(besideV, far)),
            select(plane, perpendicular * scale, PlainVec3{0.0f, 0.0f, 1.0f}),
            select(plane, 1.0f, kAllDirections),
            0.0f,
            select(maskOf((emitter.flags & kTwoSided) != 0), -power, power),
            {0.0f, 0.0f, 1.0f},
            kInfinity};
}

/// Returns the bounds that plainOf() has been given.
inline LightBounds boundsOf(const PlainBounds& b)
{
    LightBounds bounds;
    bounds.low = Vec3(b.low.x, b.low.y, b.low.z);
    bounds.high = Vec3(b.high.x, b.high.y, b.high.z);
    bounds.axis = Vec3(b.axis.x, b.axis.y, b.axis.z);
    bounds.cosCone = b.cosCone;
    bounds.cosEmission = b.cosEmission;
    bounds.intensity = std::fabs(b.intensity);
    bounds.falloff = Vec3(b.falloff.x, b.falloff.y, b.falloff.z);
    bounds.range = b.range;
    bounds.twoSided = b.intensity < 0.0f;
    return bounds;
}

} // namespace osgRayTrace::engine
