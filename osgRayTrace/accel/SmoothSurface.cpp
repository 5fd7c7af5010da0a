// SmoothSurface.cpp - applies vertex normals to the surface points of a block. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/SmoothSurface.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kSmallestTerminatorOffset = 4.0f; ///< [error bounds]
constexpr float kShortestNormal2 = 1e-12f;        ///< squared length of normals that do not count
/// kLargestTurn2 is the squared cosine of 40 degrees. A facet whose vertex normals deviate by more
/// is no piece of a smooth surface, but a side of a body whose normals were averaged at the edges:
/// at the edge of two sides of a box the deviation is 45 degrees.
constexpr float kLargestTurn2 = 0.5868f;

OSGRAYTRACE_INLINE PlainTriangle normalsOf(const TriangleLanes& lanes, int i)
{
    return {plainOf(lanes.na, i), plainOf(lanes.nb, i), plainOf(lanes.nc, i)};
}

/// The share of one vertex in the terminator offset: how far the point is below the tangent plane
/// of the vertex, along the vertex normal n, whose length is arbitrary.
struct TerminatorOffset
{
    float scale;     ///< factor of n for the way to the tangent plane; 0 if the point is above it
    uint32_t usable; ///< mask: n is within 40 degrees of the facet's normal
};

/// Returns the share of a vertex with normal n. The normal `facet` of the facet is on the ray's
/// side.
OSGRAYTRACE_INLINE TerminatorOffset terminatorOffset(PlainVec3 point, PlainVec3 vertex, PlainVec3 n,
                                                     PlainVec3 facet)
{
    const float length2 = dot(n, n);
    const float cosine = dot(n, facet);
    const float height = dot(point - vertex, n);
    TerminatorOffset result;
    // The signs of height and cosine both change with the sign of n, so the terminator offset
    // points to the side of the ray and of the facet's normal for either sign.
    const float below = select(height * cosine < 0.0f, -height, 0.0f);
    result.usable =
        maskOf(length2 > kShortestNormal2) & maskOf(cosine * cosine > kLargestTurn2 * length2);
    result.scale = below / select(length2 > kShortestNormal2, length2, 1.0f);
    return result;
}

/// Sets the shading normal of lane i if the lane is smooth.
OSGRAYTRACE_INLINE void interpolateNormal(const RayHitBlock& block, const TriangleLanes& t, int i,
                                          LaneMask smooth, SurfaceLanes& s)
{
    const float u = block.u[i], v = block.v[i], w = 1.0f - u - v;
    const PlainVec3 n = interpolated(normalsOf(t, i), w, u, v);
    const float length2 = dot(n, n);
    const float inverse = 1.0f / std::sqrt(length2);
    // Opposite normals can cancel; then, and in lanes without normals, the geometric normal stays.
    const uint32_t use = maskOf(length2 > 1e-12f) & laneBit(smooth, i);
    setLane(s.shadingNormal, i, select(use, n * inverse, plainOf(s.shadingNormal, i)));
}

/// Moves the point of lane i by its terminator offset. Returns all bits if the point has one.
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
    // An offset of less than a few error bounds is rounding, as on flat facets.
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
