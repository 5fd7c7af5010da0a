// Mesh.h - triangles in object space, and a use of them somewhere in the scene. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/base/NeverDestroyed.h"
#include "osgRayTrace/base/SharedArray.h"
#include "osgRayTrace/scene/TextureMapping.h"

#include <cstdint>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

/// Grows with each change of anything; stamps are compared and never counted.
using Stamp = uint64_t;

/// Holds indexed triangles. A mesh is immutable once it is part of a Scene.
struct Mesh
{
    std::string name; ///< node path, for messages
    SharedArray<Vec3>
        positions; ///< finite; Embree reads 4 bytes past the last one: see padPositions
    SharedArray<UVec3> triangles; ///< each index < positions.size()
    SharedArray<Vec3> normals;    ///< unit, one a position; empty: the geometric normal is used
    SharedArray<Vec2> uvs;        ///< texture unit 0, one a position; may be empty
    SharedArray<Vec2> uvs1;       ///< texture unit 1; may be empty
    SharedArray<float> rs, rs1;   ///< third coordinates of units 0 and 1; empty: 0
    /// Coordinates of texture unit kFirstMoreUvs + i; those that no material reads are empty.
    std::vector<SharedArray<Vec2>> moreUvs;
    SharedArray<Vec4> colors; ///< RGBA vertex colours, one a position; may be empty
    /// Directions in which s grows, with the sign of the bitangent w cross(normal, tangent), of any
    /// length, one a position; empty: VertexTangents.h makes them where materials need them.
    SharedArray<Vec4> tangents;
    /// True if the positions have changed before and the triangles have not: the triangles are then
    /// the array that they were. The BVH of such a mesh is built so that it can be refitted.
    bool deforms = false;
    Stamp changed = 0;
};

/// Returns the texture coordinates of a set, which may be empty.
inline const SharedArray<Vec2>& uvsOfSet(const Mesh& mesh, uint32_t set)
{
    static const NeverDestroyed<SharedArray<Vec2>> none;
    if (set < kFirstMoreUvs) return set == 0 ? mesh.uvs : mesh.uvs1;
    const std::size_t more = set - kFirstMoreUvs;
    return more < mesh.moreUvs.size() ? mesh.moreUvs[more] : *none;
}

/// Places a mesh in the scene with a material. A scene may hold very many instances, so that there
/// is no member more than needed.
struct Instance
{
    uint32_t mesh = 0;         ///< index into Scene::meshes
    uint32_t material = 0;     ///< index into Scene::materials
    uint32_t light = kInvalid; ///< index into Scene::lights if it emits, else kInvalid
    bool placed = false;       ///< false: positions are in engine space already, transform unused
    bool mirrored = false;     ///< determinant < 0: the winding is reversed
    Affine engineFromLocal;    ///< used if placed; invertible and finite (the converter checks)
    Stamp changed = 0;
};

} // namespace osgRayTrace::engine
