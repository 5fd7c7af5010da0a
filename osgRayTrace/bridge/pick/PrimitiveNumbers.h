// PrimitiveNumbers.h - from a triangle of a mesh to the primitive it was made of. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/geometry/TriangleList.h"
#include "osgRayTrace/scene/Mesh.h"

#include <osg/Geometry>

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Where a triangle of a mesh is in its geometry.
struct GeometryTriangle
{
    uint32_t primitive =
        kInvalid;         ///< as osgUtil's intersectors count; kInvalid: cut by a clip plane
    UVec3 rows{kInvalid}; ///< of the vertex arrays
};

/// Of one geometry. Takes no memory if its primitives are one triangle after the other and all of
/// them are in the mesh; else 4 bytes a triangle, and as much a vertex where vertices were split.
class PrimitiveNumbers
{
public:
    /// The mesh was made of the geometry, whose primitive sets have not changed since.
    PrimitiveNumbers(const osg::Geometry& geometry, const PrimitiveRestart& restart,
                     const Mesh& mesh);

    /// Whether it was made for a mesh with these triangles.
    bool isOf(const Mesh& mesh) const
    {
        return _triangles.data() == mesh.triangles.data() &&
               _triangles.size() == mesh.triangles.size();
    }

    GeometryTriangle at(uint32_t triangle) const;

private:
    SharedArray<UVec3> _triangles;     ///< of the mesh; kept so that their address stays theirs
    uint32_t _vertexCount = 0;         ///< of the geometry, after the split
    std::vector<uint32_t> _primitives; ///< of each triangle; empty: its own number
    std::vector<uint32_t> _rows;       ///< of each vertex; empty: its own number
};

} // namespace osgRayTrace::engine
