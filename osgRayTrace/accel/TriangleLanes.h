// TriangleLanes.h - triangles in lanes, and one triangle as loops over lanes take it. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"

namespace osgRayTrace::engine
{

/// What is read from the meshes, lane by lane; everything after it is arithmetic on lanes.
struct TriangleLanes
{
    Vec3Lanes a, b, c;    ///< vertices, engine space
    Vec3Lanes na, nb, nc; ///< vertex normals, engine space, any length; zero: geometric normal
    FloatLanes
        transformBound; ///< magnitude of what was added up to place the vertices; 0 if not placed
};

/// The vertices of one triangle.
struct PlainTriangle
{
    PlainVec3 a, b, c;
};

OSGRAYTRACE_INLINE PlainTriangle triangleOf(const TriangleLanes& lanes, int i)
{
    return {plainOf(lanes.a, i), plainOf(lanes.b, i), plainOf(lanes.c, i)};
}

/// The vectors at the vertices, interpolated: w, u and v are the weights of a, b and c.
OSGRAYTRACE_INLINE PlainVec3 interpolated(const PlainTriangle& t, float w, float u, float v)
{
    return {w * t.a.x + u * t.b.x + v * t.c.x, w * t.a.y + u * t.b.y + v * t.c.y,
            w * t.a.z + u * t.b.z + v * t.c.z};
}

/// The plane of a triangle.
struct TrianglePlane
{
    PlainVec3 normal; ///< unit, on the counter-clockwise side; 0 for a triangle without area
    float offset;     ///< error bound of points on it
    float minCosine;  ///< see SurfaceLanes
};

} // namespace osgRayTrace::engine
