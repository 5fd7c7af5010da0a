// SurfaceTable.h - what shading needs of each instance, one cache line or two. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Mesh.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Pointers into the Scene's meshes; null where a mesh lacks the attribute.
struct SurfaceRecord
{
    const UVec3* triangles = nullptr;
    const Vec3* positions = nullptr;
    const Vec3* normals = nullptr;
    const Vec2* uvs = nullptr;
    const Vec2* uvs1 = nullptr;
    const Vec4* colors = nullptr;
    const Instance* placed = nullptr; ///< its transforms; null: positions are in engine space
    uint32_t material = 0;
    uint32_t light = kInvalid;
};

/// Indexed by instance.
using SurfaceTable = std::vector<SurfaceRecord>;

} // namespace osgRayTrace::engine
