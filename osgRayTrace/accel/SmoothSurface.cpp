// SmoothSurface.cpp - what vertex normals make of the surface points of a block. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/SmoothSurface.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kSmallestTerminatorOffset = 4.0f; ///< [error bounds]
constexpr float kShortestNormal2 = 1e-12f;        ///< squared length below which a normal is none
/// Squared cosine of 40 degrees. A facet that a vertex normal leaves by more is no piece of a
/// smooth surface, but a side of a body whose edges were averaged: two sides of a box make 45
/// degrees.
constexpr float kLargestTurn2 = 0.5868f;

OSGRAYTRACE_INLINE PlainTriangle normalsOf(const TriangleLanes& lanes, int i)
{
    return {plainOf(lanes.na, i), plainOf(lanes.nb, i), plainOf(lanes.nc, i)};
}

/// The terms of the terminator offset that one vertex adds to: how far the point is below the
/// vertex's tangent plane, along its normal n of any length, on the side of the sign.
struct TerminatorOffset
{
    float scale;     ///< times n is the way to the tangent plane; 0 if the point is above it
    uint32_t usable; ///< n is about that of the facet
};

/// facet: the facet's normal, on the side of the ray.
OSGRAYTRACE_INLINE TerminatorOffset terminatorOffset(PlainVec3 point, PlainVec3 vertex, PlainVec3 n,
                                                     PlainVec3 facet)
{
    const float length2 = dot(n, n);
    const float cosine = dot(n, facet);
    const float height = dot(point - vertex, n);
    TerminatorOffset result;
    // Both signs change with n: the terminator offset is to the ray's side, where the facet's
    // normal is, whichever way n looks.
    const float below = select(height * cosine < 0.0f, -height, 0.0f);
    result.usable =
        maskOf(length2 > kShortestNormal2) & maskOf(cosine * cosine > kLargestTurn2 * length2);
    result.scale = below / select(length2 > kShortestNormal2, length2, 1.0f);
    return result;
}

OSGRAYTRACE_INLINE void interpolateNormal(const RayHitBlock& block, const TriangleLanes& t, int i,
                                          LaneMask smooth, SurfaceLanes& s)
{
    const float u = block.u[i], v = block.v[i], w = 1.0f - u - v;
    const PlainVec3 n = interpolated(normalsOf(t, i), w, u, v);
    const float length2 = dot(n, n);
    const float inverse = 1.0f / std::sqrt(length2);
    // Opposite normals can cancel: then, and without normals, the geometric one stays.
    const uint32_t use = maskOf(length2 > 1e-12f) & laneBit(smooth, i);
    setLane(s.shadingNormal, i, select(use, n * inverse, plainOf(s.shadingNormal, i)));
}

/// Returns all bits if the point has a terminator offset.
OSGRAYTRACE_INLINE uint32_t offsetPoint(const RayHitBlock& block, const TriangleLanes& t, int i,
                                        LaneMask smooth, SurfaceLanes& s)
{
    const float u = block.u[i], v = block.v[i], w = 1.0f - u - v;
    const PlainVec3 p = plainOf(s.position, i), facet = plainOf(s.geometricNormal, i);
    const PlainTriangle vertices = triangleOf(t, i), normals = normalsOf(t, i);
    const TerminatorOffset a = terminatorOffset(p, vertices.a, normals.a, facet);
    const TerminatorOffset b = terminatorOffset(p, vertices.b, normals.b, facet);
    const TerminatorOffset c = terminatorOffset(p, vertices.c, normals.c, facet);
    const PlainVec3 offset = interpolated(normals, w * a.scale, u * b.scale, v * c.scale);
    // Less than a few error bounds is rounding, as on flat facets.
    const uint32_t clear = maskOf(dot(offset, facet) > kSmallestTerminatorOffset * s.offset[i]);
    const uint32_t use = clear & a.usable & b.usable & c.usable & laneBit(smooth, i);
    setLane(s.onTriangle, i, p);
    setLane(s.position, i, p + select(use, offset, PlainVec3{0.0f, 0.0f, 0.0f}));
    return use;
}

} // namespace

OSGRAYTRACE_KERNEL
void interpolateNormals(const RayHitBlock& block, const TriangleLanes& t, LaneMask smooth,
                        SurfaceLanes& s)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        interpolateNormal(block, t, i, smooth, s);
}

OSGRAYTRACE_KERNEL
void offsetTerminator(const RayHitBlock& block, const TriangleLanes& t, LaneMask smooth,
                      SurfaceLanes& s)
{
    LaneMask terminatorLanes = 0;
    OSGRAYTRACE_SIMD_OR(terminatorLanes)
    for (int i = 0; i < kLanes; ++i)
        terminatorLanes |= bitOfLane(offsetPoint(block, t, i, smooth, s), i);
    s.terminatorLanes = terminatorLanes & s.hits;
}

} // namespace osgRayTrace::engine
