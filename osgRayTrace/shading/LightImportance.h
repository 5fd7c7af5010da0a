// LightImportance.h - the light that a node of a light tree may send to a point. Layer: shading.
// SPDX-License-Identifier: MIT
//
// Some lights lie in a box with half extents h and half diagonal r, and their normals lie in a cone
// of half-angle o around an axis. Each of them shines into directions that are up to e away from
// its normal [Conty18, sect. 4.1]. With D the vector from a surface point with normal n to the
// centre of the box, the light that the point gets from them without occlusion is about
//
//   importance = I sqrt(C_l C_s B_l B_s) / (c + l d + q d^2),   d^2 = |D|^2 + r^2 / 3
//   C_s m = (s + max(s, S)) / 2,   B_s m = min(m, s + S),   s = n . D,           S = |n| . h
//   C_l m = (g + max(g, G)) / 2,   B_l m = min(m, g + G),   g = |D| cos(w - o),  G = |axis| . h
//                                                                                    + r sin o
//
// where w is the angle between the axis and -D, w - o is 0 at least, |n| has the magnitudes of n's
// components, G is r at most, and m is about the distance of the box. C and B stand for cosines,
// and for a far box all of it is [Conty18, eq. 3] without the angle of the box. That equation takes
// the largest cosines that any of the lights might have, with the distance of the sphere around the
// box, or its radius within. Near a box these bounds are far above the light that comes, by factors
// that differ from box to box. Here the C are means, for s that are evenly spread over
// [s - S, s + S], and d^2 is that of lights that fill the box; the B are bounds again, as if all
// lights were at the near side of the box. Means alone lose the nearest lights of long boxes beside
// a point, which may have most of the light. Geometric means of both are close to what comes from
// boxes above, beside and around a point.
//
// For lights in reach the importance is 0 if and only if s < -S or g < -G, when all lights are
// behind the surface or all of them face away, or (for spots) w - o - b exceeds e with b the angle
// of the sphere around the box as seen from the point. The cosine at the surface has its sign
// unlike in [Conty18], so that lights behind an opaque surface cost no samples. The last factor is
// OpenGL's attenuation [OpenGL21, eq. 2.2], which is d^2 for areas. Beyond the largest range of the
// lights the importance is 0.
#pragma once

#include "osgRayTrace/base/QuickCompare.h"
#include "osgRayTrace/shading/LightBounds.h"

namespace osgRayTrace::engine
{

/// Returns the half extents of a node's box, rounded up.
OSGRAYTRACE_INLINE PlainVec3 halfExtents(const LightNode& node)
{
    constexpr uint32_t kTenBits = 1023;
    const PlainVec3 steps{
        static_cast<float>(static_cast<int32_t>(node.extents & kTenBits)),
        static_cast<float>(static_cast<int32_t>((node.extents >> 10) & kTenBits)),
        static_cast<float>(static_cast<int32_t>((node.extents >> 20) & kTenBits))};
    return steps * (node.radius * (1.0f / 1023.0f));
}

/// Returns the sum of the half extents of a box times the magnitudes of v's components.
OSGRAYTRACE_INLINE float extentAlong(PlainVec3 half, PlainVec3 v)
{
    return std::fabs(v.x) * half.x + std::fabs(v.y) * half.y + std::fabs(v.z) * half.z;
}

/// Returns about the square of the distance of a box, whose centre is at d, from the origin. Points
/// within are taken to be some way off the lights: half of the least half extent, or more.
OSGRAYTRACE_INLINE float clearance2(PlainVec3 d, PlainVec3 half, float radius)
{
    const PlainVec3 beyond{atLeast(std::fabs(d.x) - half.x, 0.0f),
                           atLeast(std::fabs(d.y) - half.y, 0.0f),
                           atLeast(std::fabs(d.z) - half.z, 0.0f)};
    const float thin = atMost(half.x, atMost(half.y, half.z));
    const float within = 0.5f * (thin * thin) + 0.003f * (radius * radius);
    return atLeast(dot(beyond, beyond) + within, 1e-30f);
}

/// Cosines below this bound count as the bound: at grazing angles rounding decides on the sign.
constexpr float kGrazing = 1e-4f;

/// Returns cos(max(0, a - b)) for angles in [0, pi].
OSGRAYTRACE_INLINE float cosOfDifference(float cosA, float sinA, float cosB, float sinB)
{
    return select(cosA > cosB, 1.0f, cosA * cosB + sinA * sinB);
}

/// Tells which lights a node may hold. Those of areas have neither range nor spot, and fade with
/// the square of the distance: five words less to gather, for the same importance.
enum class NodeLights
{
    Any,
    Areas,
};

/// Returns C times B: see the top. mean: s or g. extent: S or G. perDistance: 1 / m.
OSGRAYTRACE_INLINE float cosines(float mean, float extent, float perDistance)
{
    const float average = 0.5f * (mean + atLeast(mean, extent)) * perDistance;
    const float bound = atMost((mean + extent) * perDistance, 1.0f);
    return atLeast(average, kGrazing) * atLeast(bound, kGrazing);
}

/// Returns whether lights of a node may shine as far from their normals as a point is, whose
/// direction is away from the node's axis by this cosine.
OSGRAYTRACE_INLINE uint32_t mayShineTo(const LightNode& node, float distance2, float cosAxis)
{
    const float radius2 = node.radius * node.radius;
    const uint32_t outside = maskOf(distance2 > radius2);
    const float sin2Box = select(outside, radius2 / select(outside, distance2, 1.0f), 0.0f);
    const float cosBox = select(outside, std::sqrt(1.0f - sin2Box), -1.0f);
    const float cosBeyond =
        cosOfDifference(cosAxis, sineOf(cosAxis), node.cosCone, sineOf(node.cosCone));
    const float cosLight =
        cosOfDifference(cosBeyond, sineOf(cosBeyond), cosBox, std::sqrt(sin2Box));
    return maskOf(cosLight > node.cosEmission - kGrazing);
}

/// Returns the importance of a node for a surface point. normal: unit, on the side from which light
/// comes; the zero vector if light comes from both sides.
template <NodeLights kLights = NodeLights::Any>
OSGRAYTRACE_INLINE float importance(const LightNode& node, PlainVec3 p, PlainVec3 normal)
{
    const PlainVec3 d{node.centre[0] - p.x, node.centre[1] - p.y, node.centre[2] - p.z};
    const PlainVec3 axis{node.axis[0], node.axis[1], node.axis[2]};
    const PlainVec3 half = halfExtents(node);
    const float centre2 = dot(d, d), centre = std::sqrt(centre2);
    const float mean2 = atLeast(centre2 + (1.0f / 3.0f) * (node.radius * node.radius), 1e-30f);
    const float perDistance = 1.0f / std::sqrt(clearance2(d, half, node.radius));
    const float rounding = -kGrazing * (centre + node.radius) - 1e-30f; // never -0: isLess()

    const float signedAlong = -dot(d, axis);
    const float along = select(signMask(node.intensity), std::fabs(signedAlong), signedAlong);
    const float across = std::sqrt(atLeast(centre2 - along * along, 0.0f));
    const float sinCone = sineOf(node.cosCone);
    const float facing = select(isLess(node.cosCone * centre, along), centre,
                                along * node.cosCone + across * sinCone);
    const float beside = atMost(extentAlong(half, axis) + node.radius * sinCone, node.radius);
    const float facingExtent = select(isLess(0.0f, node.cosCone), beside, node.radius);

    const float above = dot(d, normal), aboveExtent = extentAlong(half, normal);
    const uint32_t bothSides = maskOf(!(dot(normal, normal) > 0.0f));
    const float surface = select(bothSides, 1.0f, cosines(above, aboveExtent, perDistance));
    const float unfaded =
        std::fabs(node.intensity) * std::sqrt(cosines(facing, facingExtent, perDistance) * surface);

    const uint32_t litSide = isLess(rounding, above + aboveExtent) | bothSides;
    const uint32_t faces = isLess(rounding, facing + facingExtent);
    if constexpr (kLights == NodeLights::Areas)
        return select(litSide & faces, unfaded / mean2, 0.0f);

    // Areas alone have an emission of exactly a hemisphere.
    const float cosAxis = along / atLeast(centre, 1e-15f);
    const uint32_t hemisphere = maskOf(node.cosEmission == 0.0f);
    const uint32_t shines =
        (faces & hemisphere) | (mayShineTo(node, centre2, cosAxis) & ~hemisphere);
    const float fading =
        node.falloff[0] + node.falloff[1] * std::sqrt(mean2) + node.falloff[2] * mean2;
    const uint32_t inReach = maskOf(centre2 <= node.reach * node.reach);
    return select(litSide & shines & inReach, unfaded / atLeast(fading, 1e-30f), 0.0f);
}

} // namespace osgRayTrace::engine
