// VertexTangents.h - tangents at vertices of meshes that have none of their own. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Mesh.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Holds tangents with the signs of their bitangents, as Mesh::tangents has them, and which of them
/// the corners of each triangle have; kInvalid: none.
struct VertexTangents
{
    std::vector<Vec4> tangents;
    std::vector<UVec3> triangles;
};

/// Returns the tangents of a mesh by texture coordinates, as MikkTSpace has them [Mikkelsen08,
/// sect. 2.3]: the directions in which s grows over the triangles around a vertex, each in the
/// plane of the vertex normal and weighted by the triangle's angle there. Vertices with the same
/// place, normal and coordinates count as one; triangles whose coordinates wind the other way have
/// a mean of their own. A triangle without area in the texture takes the tangents of its
/// neighbours. MikkTSpace also parts triangles that meet at a vertex alone, without a common edge;
/// here they share their mean. The mesh needs normals.
VertexTangents vertexTangents(const Mesh& mesh, const SharedArray<Vec2>& uvs);

} // namespace osgRayTrace::engine
