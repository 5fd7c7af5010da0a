// MeshCorners.h - the corners of a mesh's triangles, for loops over very many. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Kernel.h"
#include "osgRayTrace/shading/EmissiveMesh.h"

namespace osgRayTrace::engine
{

/// A corner of a triangle and its edges from there, in engine space.
struct MeshCorners
{
    Vec3 a, ab, ac;
};

/// Returns the corners of a triangle of a mesh at a place.
OSGRAYTRACE_INLINE MeshCorners cornersOf(const Mesh& mesh, const MeshPlace& place,
                                         std::size_t primitive)
{
    const UVec3& t = mesh.triangles[primitive];
    Vec3 p[3] = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    if (place.placed)
        for (Vec3& q : p)
            q = transformPoint(place.engineFromLocal, q);
    return {p[0], p[1] - p[0], p[2] - p[0]};
}

} // namespace osgRayTrace::engine
