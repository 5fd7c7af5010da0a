// LightImportance.h - the light that a node of a light tree may send to a point. Layer: shading.
// SPDX-License-Identifier: MIT
//
// Some lights lie in a box with half extents h and half diagonal r, and their normals lie in a cone
// of half-angle o around an axis. Each of them shines into directions that are up to e away from
// its normal [Conty18, sect. 4.1]. With D the vector from a surface point with normal n to the
// centre of the box, the light that the point gets from them without occlusion is about
//
//   importance = I C_l C_s / (c + l d + q d^2),   d^2 = |D|^2 + r^2 / 6
//   C_s d = (s + max(s, S)) / 2,   s = n . D,            S = |n| . h
//   C_l d = (g + max(g, G)) / 2,   g = |D| cos(w - o),   G = |axis| . h + r sin o, at most r
//
// where w is the angle between the axis and -D, w - o is 0 at least, and |n| has the magnitudes of
// n's components. For a far box this is [Conty18, eq. 3] without the angle of the box. That
// equation takes the least distance and the largest cosines that any of the lights might have. Near
// a box these bounds are far above the light that comes, by factors that differ from box to box:
// one sample of a thousand lamps under a ceiling then has 6 to 16 times the variance. So the terms
// here are means. The cosine s is taken to be evenly spread over [s - S, s + S], and (s + S) / 2
// stands for the mean of what is above 0 in it. The square of the distance is that of the centre,
// and half of the variance r^2 / 3 of lights that fill the box, as the nearer lights count for
// more.
//
// The importance is 0 if and only if s < -S or g < -G, when all lights are behind the surface or
// all of them face away, or (for spots) w - o - b exceeds e with b the angle of the sphere around
// the box as seen from the point. The cosine at the surface has its sign unlike in [Conty18], so
// that lights behind an opaque surface cost no samples. The last factor is OpenGL's attenuation
// [OpenGL21, eq. 2.2], which is d^2 for areas. Beyond the largest range of the lights the
// importance is 0.
#pragma once

#include "osgRayTrace/shading/LightBounds.h"

namespace osgRayTrace::engine
{

/// Returns the sum of the half extents of a node's box times the magnitudes of v's components.
OSGRAYTRACE_INLINE float extentAlong(const LightNode& node, PlainVec3 v)
{
    constexpr uint32_t kTenBits = 1023;
    const auto x = static_cast<float>(static_cast<int32_t>(node.extents & kTenBits));
    const auto y = static_cast<float>(static_cast<int32_t>((node.extents >> 10) & kTenBits));
    const auto z = static_cast<float>(static_cast<int32_t>((node.extents >> 20) & kTenBits));
    const float sum = std::fabs(v.x) * x + std::fabs(v.y) * y + std::fabs(v.z) * z;
    return sum * (node.radius * (1.0f / 1023.0f));
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

/// Returns about the mean of what is above 0 in [mean - extent, mean + extent]: see the top.
OSGRAYTRACE_INLINE float meanAbove(float mean, float extent)
{
    return 0.5f * (mean + select(mean > extent, mean, extent));
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
    constexpr float kVariance = 1.0f / 6.0f;
    const PlainVec3 d{node.centre[0] - p.x, node.centre[1] - p.y, node.centre[2] - p.z};
    const PlainVec3 axis{node.axis[0], node.axis[1], node.axis[2]};
    const float centre2 = dot(d, d);
    const float mean2 = centre2 + kVariance * (node.radius * node.radius);
    const float clear2 = select(mean2 > 1e-30f, mean2, 1e-30f);
    const float inverse = 1.0f / std::sqrt(clear2);
    const float rounding = -kGrazing * (clear2 * inverse);

    const float centre = std::sqrt(centre2);
    const float signedAlong = -dot(d, axis);
    const float along = select(node.intensity < 0.0f, std::fabs(signedAlong), signedAlong);
    const float across2 = centre2 - along * along;
    const float across = std::sqrt(select(across2 > 0.0f, across2, 0.0f));
    const float sinCone = sineOf(node.cosCone);
    const float facing =
        select(along > node.cosCone * centre, centre, along * node.cosCone + across * sinCone);
    const float beside = extentAlong(node, axis) + node.radius * sinCone;
    const uint32_t narrow = maskOf(node.cosCone > 0.0f) & maskOf(beside < node.radius);
    const float facingExtent = select(narrow, beside, node.radius);
    const float cosLight = meanAbove(facing, facingExtent) * inverse;
    const float light = select(cosLight > kGrazing, cosLight, kGrazing);

    const float above = dot(d, normal), aboveExtent = extentAlong(node, normal);
    const float cosSurface = meanAbove(above, aboveExtent) * inverse;
    const float oneSided = select(cosSurface > kGrazing, cosSurface, kGrazing);
    const uint32_t bothSides = maskOf(!(dot(normal, normal) > 0.0f));
    const float surface = select(bothSides, 1.0f, oneSided);

    const uint32_t litSide = maskOf(above + aboveExtent > rounding) | bothSides;
    const uint32_t faces = maskOf(facing + facingExtent > rounding);
    const float unfaded = std::fabs(node.intensity) * light * surface;
    if constexpr (kLights == NodeLights::Areas)
        return select(litSide & faces, unfaded * (inverse * inverse), 0.0f);

    // Areas alone have an emission of exactly a hemisphere.
    const float cosAxis = along / select(centre > 1e-15f, centre, 1e-15f);
    const uint32_t hemisphere = maskOf(node.cosEmission == 0.0f);
    const uint32_t shines =
        (faces & hemisphere) | (mayShineTo(node, centre2, cosAxis) & ~hemisphere);
    const float fading =
        node.falloff[0] + node.falloff[1] * (clear2 * inverse) + node.falloff[2] * clear2;
    const uint32_t inReach = maskOf(centre2 <= node.reach * node.reach);
    return select(litSide & shines & inReach, unfaded / select(fading > 1e-30f, fading, 1e-30f),
                  0.0f);
}

/// Returns the probability of the first node of a pair.
template <NodeLights kLights = NodeLights::Any>
OSGRAYTRACE_INLINE float shareOfFirst(const LightNode& first, const LightNode& second, PlainVec3 p,
                                      PlainVec3 normal)
{
    // Rounding must not take the last chance of a node that may shine.
    constexpr float kLeastShare = 0x1p-20f;
    const float a = importance<kLights>(first, p, normal);
    const float b = importance<kLights>(second, p, normal);
    const float sum = a + b;
    const float share = select(maskOf(sum > 0.0f) & maskOf(sum < kInfinity), a / sum, 0.5f);
    const float above = select(share > kLeastShare, share, kLeastShare);
    const float within = select(above < 1.0f - kLeastShare, above, 1.0f - kLeastShare);
    const uint32_t both = maskOf(a > 0.0f) & maskOf(b > 0.0f);
    return select(both, within, share);
}

} // namespace osgRayTrace::engine
