// TriangleLanes.h - sixteen triangles in lanes, and one of them as plain values. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"

namespace osgRayTrace::engine
{

/// The triangle data that are read from the meshes lane by lane. Everything after the reading is
/// arithmetic on lanes.
struct TriangleLanes
{
    Vec3Lanes a, b, c;         ///< vertices, engine space
    Vec3Lanes na, nb, nc;      ///< vertex normals, engine space, any length; zero: geometric normal
    FloatLanes transformBound; ///< magnitude of the sums that place vertices; 0: not placed
};

/// The vertices of one triangle, or the vectors at its vertices.
struct PlainTriangle
{
    PlainVec3 a, b, c;
};

/// Returns the vertices of lane i.
OSGRAYTRACE_INLINE PlainTriangle triangleOf(const TriangleLanes& lanes, int i)
{
    return {plainOf(lanes.a, i), plainOf(lanes.b, i), plainOf(lanes.c, i)};
}

/// Returns the interpolated vector: w, u and v are the weights of a, b and c.
OSGRAYTRACE_INLINE PlainVec3 interpolated(const PlainTriangle& t, float w, float u, float v)
{
    return {w * t.a.x + u * t.b.x + v * t.c.x, w * t.a.y + u * t.b.y + v * t.c.y,
            w * t.a.z + u * t.b.z + v * t.c.z};
}

/// The plane of a triangle.
struct TrianglePlane
{
    PlainVec3 normal; ///< unit, on the counter-clockwise side; 0 for a triangle without area
    float offset;     ///< error bound of points on the plane
    float minCosine;  ///< see SurfaceLanes
};

} // namespace osgRayTrace::engine
