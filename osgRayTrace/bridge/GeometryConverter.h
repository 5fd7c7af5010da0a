// GeometryConverter.h - from an osg::Geometry to a Mesh. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/ConversionReport.h"
#include "osgRayTrace/bridge/TriangleList.h"
#include "osgRayTrace/scene/Mesh.h"

#include <osg/Geometry>
#include <osg/Matrixd>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

/// What a mesh depends on beside the geometry's own arrays.
struct MeshRequest
{
    /// Applied to positions in double, and to normals; nothing: identity, then arrays may be
    /// shared.
    std::optional<osg::Matrixd> transform;
    bool decodeColors = false; ///< vertex colours from sRGB to linear
    float lift = 0.0f;         ///< layers that the faces are raised by: see polygonLift
    bool copies = false;       ///< shares no arrays: they will change
    PrimitiveRestart restart;
    std::vector<Vec4d> clipPlanes; ///< after the transform; see clip

    bool operator==(const MeshRequest& other) const
    {
        return transform == other.transform && decodeColors == other.decodeColors &&
               lift == other.lift && copies == other.copies && restart == other.restart &&
               clipPlanes == other.clipPlanes;
    }
};

/// Which rows of the OSG arrays the mesh's vertices are. Needed when an array has one value for
/// each primitive set, so that a vertex of two sets becomes two.
struct VertexMap
{
    std::size_t vertexCount = 0;
    std::vector<uint32_t> rows; ///< of per-vertex arrays; empty: vertex i is row i
    std::vector<uint32_t>
        primitiveSets; ///< row of arrays that are bound per primitive set; may be empty
};

struct ConvertedMesh
{
    std::shared_ptr<Mesh> mesh; ///< null if nothing is left to trace; then counts tell why
    ConversionCounts counts;
};

/// Arrays of an earlier mesh of the geometry that were made from the very same data; empty: none.
struct KeptArrays
{
    SharedArray<Vec3> normals;
    SharedArray<Vec2> uvs;
    SharedArray<Vec2> uvs1;
    SharedArray<float> rs, rs1;
    SharedArray<Vec4> colors;
};

/// Every triangle of the mesh is sound: indices in range, vertices finite and, transformed, at most
/// 1e18 in magnitude, area not zero; the others are dropped and counted. Without usable normals the
/// mesh has none, that is flat facets (OpenGL would light all of it with the last normal that some
/// other object used). Where layout, transform and DataVariance allow it the mesh shares the OSG
/// arrays and keeps them alive; nobody may then write to them while a Scene holds the mesh.
ConvertedMesh convertGeometry(const osg::Geometry& geometry, const MeshRequest& request,
                              const KeptArrays& kept = {});

/// Values differ from primitive set to primitive set: then vertices are split.
bool hasValuesBySet(const osg::Geometry& geometry);

/// Gives a vertex that is used by several primitive sets one copy for each, and renumbers the
/// triangles. Those with indices out of range are left as they are: they are dropped later.
VertexMap splitByPrimitiveSet(TriangleList& list, std::size_t vertexCount);

} // namespace osgRayTrace::engine
