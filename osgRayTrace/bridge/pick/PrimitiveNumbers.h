// PrimitiveNumbers.h - leads from a triangle of a mesh to its primitive. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/geometry/TriangleList.h"
#include "osgRayTrace/scene/Mesh.h"

#include <osg/Geometry>

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Tells where a triangle of a mesh is in its geometry.
struct GeometryTriangle
{
    /// Number of the primitive as osgUtil's intersectors count; kInvalid: cut by a clip plane.
    uint32_t primitive = kInvalid;
    UVec3 rows{kInvalid}; ///< rows of the vertex arrays; kInvalid: it is part of a solid, or cut
};

/// Numbers the primitives of one geometry. The object takes no memory if the primitives are one
/// triangle after the other and all of them are in the mesh. Otherwise it takes 4 bytes a triangle,
/// and as much a vertex if vertices were split.
class PrimitiveNumbers
{
public:
    /// The mesh must have been made of the geometry, and the geometry's primitive sets must not
    /// have changed since. solids: the mesh has the geometry's points and lines, too.
    PrimitiveNumbers(const osg::Geometry& geometry, const PrimitiveRestart& restart, bool solids,
                     const Mesh& mesh);

    /// Returns whether the numbers were made for a mesh with these triangles.
    bool isOf(const Mesh& mesh) const
    {
        return _triangles.data() == mesh.triangles.data() &&
               _triangles.size() == mesh.triangles.size();
    }

    GeometryTriangle at(uint32_t triangle) const;

private:
    void numberSolids(const TriangleList& list, const osg::Geometry& geometry, const Mesh& mesh);

    /// Triangles of the mesh, kept so that their address stays unique.
    SharedArray<UVec3> _triangles;
    uint32_t _vertexCount = 0; ///< vertices of the geometry, after the split
    /// Primitive of each triangle; empty: the triangle's own number.
    std::vector<uint32_t> _primitives;
    std::vector<uint32_t> _rows; ///< row of each vertex; empty: the vertex's own number
};

} // namespace osgRayTrace::engine
