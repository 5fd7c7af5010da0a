// SolidShape.h - tessellated unit spheres and capsules. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <cstddef>
#include <vector>

namespace osgRayTrace::engine
{

/// Lies at an end of the solid plus a unit direction, which is the normal as well. The axis of a
/// capsule is z; the hemisphere of positive z is at its far end.
struct SolidVertex
{
    Vec3d direction;
    bool atEnd = false; ///< true: at the far end of a capsule
};

struct SolidShape
{
    std::vector<SolidVertex> vertices;
    std::vector<UVec3> triangles; ///< counter-clockwise seen from outside
};

/// Octahedra whose faces are cut into n * n triangles each, pushed out to the sphere. A sphere has
/// 8n * n triangles; the hemispheres of a capsule stand apart, with a belt of 8n triangles between
/// them.
struct SolidShapes
{
    SolidShape sphere, capsule;
    /// Factor of the radius, by which the smallest and the largest distance to the surface are off
    /// by the same share.
    double outset = 1.0;
};

/// Returns the shapes for so many solids in a mesh: as fine as 2^20 triangles allow, with n from 2
/// to 8. Any thread may call this.
const SolidShapes& solidShapes(std::size_t count);

} // namespace osgRayTrace::engine
