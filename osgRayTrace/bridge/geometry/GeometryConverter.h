// GeometryConverter.h - converts an osg::Geometry to a Mesh. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/bridge/geometry/MeshRequest.h"
#include "osgRayTrace/bridge/geometry/TriangleList.h"
#include "osgRayTrace/bridge/geometry/VertexMap.h"
#include "osgRayTrace/scene/Mesh.h"

#include <osg/Geometry>
#include <osg/Matrixd>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

struct ConvertedMesh
{
    std::shared_ptr<Mesh> mesh; ///< null if nothing is left to trace; counts then tell why
    ConversionCounts counts;
};

/// Holds the arrays of an earlier mesh of the geometry that were made from the very same data; an
/// array is empty if there is none.
struct KeptArrays
{
    SharedArray<Vec3> normals;
    SharedArray<Vec2> uvs;
    SharedArray<Vec2> uvs1;
    SharedArray<float> rs, rs1;
    std::vector<SharedArray<Vec2>> moreUvs;
    SharedArray<Vec4> colors;
};

/// Converts a geometry to a mesh. Every triangle of the mesh is sound: its indices are in range,
/// its vertices are finite and, transformed, at most 1e18 in magnitude, and its area is not zero.
/// Other triangles are dropped and counted. Without usable normals the mesh has none, which means
/// flat facets (OpenGL would light all of the mesh with the last normal that some other object
/// used). If layout, transform and DataVariance allow it, the mesh shares the OSG arrays and keeps
/// them alive; nobody may then write to these arrays while a Scene holds the mesh.
ConvertedMesh convertGeometry(const osg::Geometry& geometry, const MeshRequest& request,
                              const KeptArrays& kept = {});

/// Returns whether values differ from primitive set to primitive set, so that vertices have to be
/// split.
bool hasValuesBySet(const osg::Geometry& geometry);

/// Gives a vertex that is used by several primitive sets one copy for each, and renumbers the
/// triangles. Triangles with indices out of range stay as they are: they are dropped later.
VertexMap splitByPrimitiveSet(TriangleList& list, std::size_t vertexCount);

} // namespace osgRayTrace::engine
