// TrianglePlane.h - a triangle's plane with its error bound. Layer: accel; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/TriangleLanes.h"

#include <cmath>
#include <cstring>

namespace osgRayTrace::engine
{

constexpr float kOffsetScale = 32.0f * 0x1p-24f; ///< k * 2^-24 of surfacesOf
constexpr float kEdgeScale = 8.0f * 0x1p-24f;    ///< Embree's error as a share of the longest edge

/// Rays whose cosine is above kMinCosine begin on their very point if the offset is no more than
/// the share kFineOffset of the triangle's edges. Such a ray skips four offsets of its way at most,
/// and so short a way hides nothing.
constexpr float kFineOffset = 1e-4f;
constexpr float kMinCosine = 0.25f;
constexpr float kNever = 2.0f; ///< cosine that no ray has

/// Returns the largest magnitude of three numbers.
OSGRAYTRACE_INLINE float largestMagnitude(float a, float b, float c)
{
    const float ab = std::fabs(a) > std::fabs(b) ? std::fabs(a) : std::fabs(b);
    return ab > std::fabs(c) ? ab : std::fabs(c);
}

/// Returns 2^-n for x in [2^n, 2^(n+1)), and 2^127 for 0.
OSGRAYTRACE_INLINE float inversePowerOfTwo(float x)
{
    uint32_t bits;
    std::memcpy(&bits, &x, sizeof(bits));
    bits = (254u << 23) - (bits & 0x7f800000u);
    float result;
    std::memcpy(&result, &bits, sizeof(result));
    return result;
}

/// Returns the plane of a triangle with the error bound of its points; surfacesOf says how the
/// bound is made. TriangleLanes defines transformBound, which is 0 for a triangle that is not
/// placed.
OSGRAYTRACE_INLINE TrianglePlane planeOf(const PlainTriangle& t, float transformBound)
{
    const PlainVec3 e1 = t.b - t.a, e2 = t.c - t.a;
    // The edges are scaled to about 1 by a power of two first, because length2 grows with the
    // fourth power of the edges: it would be denormal for edges below 3e-10 and infinite above 4e9.
    const float edge1 = largestMagnitude(e1.x, e1.y, e1.z),
                edge2 = largestMagnitude(e2.x, e2.y, e2.z);
    const float edge = edge1 > edge2 ? edge1 : edge2;
    const float scale = inversePowerOfTwo(edge);
    const PlainVec3 n = cross(e1 * scale, e2 * scale);
    const float length2 = dot(n, n);
    const float inverse = select(length2 > 0.0f, 1.0f / std::sqrt(length2), 0.0f);
    TrianglePlane plane;
    plane.normal = n * inverse;
    const float bound = largestMagnitude(t.a.x, t.b.x, t.c.x) * std::fabs(plane.normal.x) +
                        largestMagnitude(t.a.y, t.b.y, t.c.y) * std::fabs(plane.normal.y) +
                        largestMagnitude(t.a.z, t.b.z, t.c.z) * std::fabs(plane.normal.z);
    plane.offset = kOffsetScale * (bound + 2.0f * transformBound) + kEdgeScale * edge;
    plane.minCosine = select(plane.offset <= kFineOffset * edge, kMinCosine, kNever);
    return plane;
}

} // namespace osgRayTrace::engine
