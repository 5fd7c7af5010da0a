// EnclosedVolume.h - the volume within triangles. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

namespace osgRayTrace::engine::test
{

/// Returns the volume that the triangles of a body with positions and triangles enclose, by the
/// divergence theorem: positive if they are counter-clockwise from outside.
template <class Body> double enclosedVolume(const Body& body)
{
    double sum = 0.0;
    for (const UVec3& t : body.triangles)
        sum += glm::dot(Vec3d(body.positions[t.x]),
                        glm::cross(Vec3d(body.positions[t.y]), Vec3d(body.positions[t.z])));
    return sum / 6.0;
}

} // namespace osgRayTrace::engine::test
