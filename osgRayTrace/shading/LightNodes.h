// LightNodes.h - bounds of emitters and nodes of a light tree, for loops over very many. Layer:
// shading.
// SPDX-License-Identifier: MIT
//
// A value of LightBounds that a function returns goes through memory, and its reader waits for it:
// these functions become part of the loop.
#pragma once

#include "osgRayTrace/shading/LightEmitters.h"

#include <algorithm>

namespace osgRayTrace::engine
{

/// The half-angles of a cone and of what is near it are taken so much larger, against rounding.
constexpr float kConeSlack = 1e-5f;

/// Ranges are taken so many times, against rounding.
constexpr float kReachSlack = 1.00001f;

/// A cone of directions.
struct LightCone
{
    Vec3 axis;
    float cosine;
};

constexpr float kAllDirections = -1.0f;

/// Returns the smallest cone around two [Conty18, alg. 1], without a trigonometric function.
OSGRAYTRACE_INLINE LightCone coneAround(LightCone a, LightCone b)
{
    if (b.cosine < a.cosine) std::swap(a, b); // a is the wider one
    if (a.cosine <= kAllDirections) return {a.axis, kAllDirections};
    const float cosBetween = std::clamp(glm::dot(a.axis, b.axis), -1.0f, 1.0f);
    const float sinBetween = sineOf(cosBetween), sinA = sineOf(a.cosine), sinB = sineOf(b.cosine);
    // The angle from a's axis to the far side of b is between + b.
    const float cosFar = cosBetween * b.cosine - sinBetween * sinB;
    const float sinFar = sinBetween * b.cosine + cosBetween * sinB;
    if (sinFar >= 0.0f && cosFar >= a.cosine) return a;
    // The axis turns by t = (between + b - a) / 2 towards b's.
    const float cosTwice = cosFar * a.cosine + sinFar * sinA;
    const float sinTwice = sinFar * a.cosine - cosFar * sinA;
    const float sinTurn = std::sqrt(std::max(0.0f, 0.5f - 0.5f * cosTwice));
    const float halfCosine = std::sqrt(std::max(0.0f, 0.5f + 0.5f * cosTwice));
    const float cosTurn = sinTwice < 0.0f ? -halfCosine : halfCosine;
    const float sinAll = sinTurn * a.cosine + cosTurn * sinA;
    const float cosAll = cosTurn * a.cosine - sinTurn * sinA;
    if (sinAll <= 0.0f || sinBetween <= 1e-4f)
        return cosBetween > 0.0f && sinAll > 0.0f ? LightCone{a.axis, std::min(cosAll, cosFar)}
                                                  : LightCone{a.axis, kAllDirections};
    const Vec3 across = (b.axis - a.axis * cosBetween) / sinBetween;
    const Vec3 axis = a.axis * cosTurn + across * sinTurn;
    return {axis / glm::length(axis), std::max(cosAll - kConeSlack, kAllDirections)};
}

/// Returns what joined() returns.
OSGRAYTRACE_INLINE LightBounds joinedBounds(const LightBounds& a, const LightBounds& b)
{
    if (!(b.intensity > 0.0f)) return a;
    if (!(a.intensity > 0.0f)) return b;
    LightBounds both;
    both.low = glm::min(a.low, b.low);
    both.high = glm::max(a.high, b.high);
    both.twoSided = a.twoSided || b.twoSided;
    // The normals of lights that shine to both sides may be taken either way.
    const bool turned = a.twoSided && b.twoSided && glm::dot(a.axis, b.axis) < 0.0f;
    const LightCone cone =
        coneAround(LightCone{a.axis, a.cosCone}, LightCone{turned ? -b.axis : b.axis, b.cosCone});
    both.axis = cone.axis;
    both.cosCone = cone.cosine;
    both.cosEmission = std::min(a.cosEmission, b.cosEmission);
    both.range = std::max(a.range, b.range);
    both.intensity = a.intensity + b.intensity;
    const float share = b.intensity / both.intensity;
    both.falloff = a.falloff + (b.falloff - a.falloff) * share;
    return both;
}

/// Sets a node to what nodeOf() returns.
OSGRAYTRACE_INLINE void setNode(LightNode& node, const LightBounds& bounds, uint32_t next)
{
    const Vec3 centre = 0.5f * (bounds.low + bounds.high);
    for (int k = 0; k < 3; ++k)
    {
        node.centre[k] = centre[k];
        node.axis[k] = bounds.axis[k];
        node.falloff[k] = bounds.falloff[k];
    }
    node.radius = glm::length(glm::max(bounds.high - centre, centre - bounds.low));
    node.cosCone = bounds.cosCone;
    node.sinCone = sineOf(bounds.cosCone);
    node.cosEmission = bounds.cosEmission;
    node.intensity = bounds.twoSided ? -bounds.intensity : bounds.intensity;
    node.next = next;
    node.reach = (bounds.range + node.radius) * kReachSlack;
}

/// Returns what boundsOf() returns for a parallelogram or a triangle.
OSGRAYTRACE_INLINE LightBounds areaBounds(const LightEmitter& emitter)
{
    const auto vectorOf = [](const float(&words)[3]) { return Vec3(words[0], words[1], words[2]); };
    const Vec3 corner = vectorOf(emitter.corner), u = vectorOf(emitter.edgeU),
               v = vectorOf(emitter.edgeV);
    const Vec3 far = emitter.flags & kTriangle ? corner + u : corner + u + v;
    LightBounds bounds;
    bounds.low = glm::min(glm::min(corner, corner + u), glm::min(corner + v, far));
    bounds.high = glm::max(glm::max(corner, corner + u), glm::max(corner + v, far));
    const Vec3 perpendicular = glm::cross(u, v);
    const float length = glm::length(perpendicular);
    const bool plane = length > 1e-30f && length < 1e30f;
    if (plane)
        bounds.axis = perpendicular / length;
    else
        bounds.cosCone = -1.0f;
    bounds.intensity = luminance(vectorOf(emitter.radiance)) * emitter.area;
    bounds.twoSided = (emitter.flags & kTwoSided) != 0;
    return bounds;
}

} // namespace osgRayTrace::engine
