// LightBounds.h - bounds of the light that some lights send to a point. Layer: shading.
// SPDX-License-Identifier: MIT
//
// Some lights lie in a box, and their normals lie in a cone of half-angle o around an axis. Each of
// them shines into directions that are up to e away from its normal [Conty18, sect. 4.1]. The light
// that a surface point with normal n gets from them without occlusion is about
//
//   importance = I cos(max(0, w - o - b)) cos(max(0, i - b)) / (c + l d + q d^2)
//
// and 0 if w - o - b exceeds e or i - b exceeds a right angle [Conty18, eq. 3]. The distance d is
// that of the sphere around the box, or its radius within the sphere, b the angle of this sphere as
// seen from the point, w the angle between the axis and the direction from the sphere to the point,
// and i that between n and the direction to the sphere. The cosine at the surface has its sign
// unlike in [Conty18], so that lights behind an opaque surface cost no samples. The last factor is
// OpenGL's attenuation [OpenGL21, eq. 2.2], which is d^2 for areas. Beyond the largest range of the
// lights the importance is 0.
#pragma once

#include "osgRayTrace/base/Lanes.h"

#include <cmath>

namespace osgRayTrace::engine
{

struct LightBounds
{
    Vec3 low{0.0f}, high{0.0f};
    Vec3 axis{0.0f, 0.0f, 1.0f};    ///< unit
    float cosCone = 1.0f;           ///< cosine of o
    float cosEmission = 0.0f;       ///< cosine of e
    float intensity = 0.0f;         ///< along the normals [W/sr]
    Vec3 falloff{0.0f, 0.0f, 1.0f}; ///< c, l and q, averages by intensity
    float range = kInfinity;        ///< from the box [length]: no light comes farther
    bool twoSided = false;
};

/// Returns bounds of the lights of both.
LightBounds joined(const LightBounds& a, const LightBounds& b);

/// LightNode holds LightBounds as columns of words, which sixteen lanes gather.
struct LightNode
{
    float centre[3];
    float radius;
    float axis[3];
    float cosCone, sinCone, cosEmission;
    float intensity; ///< negative if some of the lights shine to both sides
    float falloff[3];
    uint32_t next; ///< the pair of children, or kLeaf and the emitter
    float reach;   ///< from the centre [length]: no light comes farther
};
static_assert(sizeof(LightNode) == 64, "a node is a cache line");

LightNode nodeOf(const LightBounds& bounds, uint32_t next);

/// Cosines below this bound count as the bound: at grazing angles rounding decides on the sign.
constexpr float kGrazing = 1e-4f;

/// Returns cos(max(0, a - b)) for angles in [0, pi].
OSGRAYTRACE_INLINE float cosOfDifference(float cosA, float sinA, float cosB, float sinB)
{
    return select(cosA > cosB, 1.0f, cosA * cosB + sinA * sinB);
}

OSGRAYTRACE_INLINE float sineOf(float cosine)
{
    const float square = 1.0f - cosine * cosine;
    return std::sqrt(select(square > 0.0f, square, 0.0f));
}

/// Tells which lights a node may hold. Those of areas have neither range nor spot, and fade with
/// the square of the distance: five words less to gather, for the same importance.
enum class NodeLights
{
    Any,
    Areas,
};

/// Returns the importance of a node for a surface point. normal: unit, on the side from which light
/// comes; the zero vector if light comes from both sides.
template <NodeLights kLights = NodeLights::Any>
OSGRAYTRACE_INLINE float importance(const LightNode& node, PlainVec3 p, PlainVec3 normal)
{
    const PlainVec3 d{node.centre[0] - p.x, node.centre[1] - p.y, node.centre[2] - p.z};
    const float radius2 = node.radius * node.radius;
    const float distance2 = dot(d, d);
    const uint32_t outside = maskOf(distance2 > radius2);
    const float clear2 = select(outside, distance2, radius2);
    const float sin2Box = select(outside, radius2 / clear2, 0.0f);
    const float cosBox = select(outside, std::sqrt(1.0f - sin2Box), -1.0f);
    const float sinBox = std::sqrt(sin2Box);
    const float inverse = 1.0f / std::sqrt(select(distance2 > 1e-37f, distance2, 1e-37f));

    const float along = -(d.x * node.axis[0] + d.y * node.axis[1] + d.z * node.axis[2]) * inverse;
    const float cosAxis = select(node.intensity < 0.0f, std::fabs(along), along);
    const float cosBeyond = cosOfDifference(cosAxis, sineOf(cosAxis), node.cosCone, node.sinCone);
    const float cosLight = cosOfDifference(cosBeyond, sineOf(cosBeyond), cosBox, sinBox);
    const float light = select(cosLight > kGrazing, cosLight, kGrazing);

    const float cosNormal = dot(d, normal) * inverse;
    const float cosSurface = cosOfDifference(cosNormal, sineOf(cosNormal), cosBox, sinBox);
    const float bound = select(cosSurface > kGrazing, cosSurface, kGrazing);
    const float surface = select(dot(normal, normal) > 0.0f, bound, 1.0f);

    constexpr bool kAreas = kLights == NodeLights::Areas;
    const float fading =
        kAreas ? clear2
               : node.falloff[0] + node.falloff[1] * std::sqrt(clear2) + node.falloff[2] * clear2;
    const float intensity = std::fabs(node.intensity);
    const float value = intensity * light * surface / select(fading > 1e-30f, fading, 1e-30f);
    const uint32_t inReach = kAreas ? ~0u : maskOf(distance2 <= node.reach * node.reach);
    const float cosEmission = kAreas ? 0.0f : node.cosEmission;
    const uint32_t lit = inReach & maskOf(cosLight > cosEmission - kGrazing) &
                         (maskOf(cosSurface > -kGrazing) | maskOf(!(dot(normal, normal) > 0.0f)));
    return select(lit, value, 0.0f);
}

} // namespace osgRayTrace::engine
