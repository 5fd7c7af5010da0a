// PointSolids.h - points as spheres and lines as capsules, both made of triangles. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/bridge/geometry/MeshRequest.h"
#include "osgRayTrace/bridge/geometry/TriangleList.h"
#include "osgRayTrace/scene/Mesh.h"

#include <osg/Geometry>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// A geometry has at most this many points and line segments that are traced: each of them takes
/// 32 triangles or more, and 5 to 8 kB with the BVH.
constexpr std::size_t kMostSolids = std::size_t(1) << 19;

/// Returns whether the primitive set is of points or lines that can be traced.
bool hasSolids(const osg::PrimitiveSet& set);

/// Returns the number of points and line segments of a geometry.
std::size_t solidCount(const osg::Geometry& geometry);

/// Returns the radius with which the points and lines of a geometry are traced: 0, by which OSG
/// draws them, if there are none or more than kMostSolids. wanted: RayTraceSettings' point radius.
float solidRadius(const osg::Geometry& geometry, float wanted);

/// Returns whether points and lines that are traced are all that the geometry has.
bool hasSolidsAlone(const osg::Geometry& geometry, float wanted);

/// Appends to the mesh, which may be empty, a sphere for each point and a capsule for each line
/// segment, with MeshRequest's radius in the geometry's own coordinates: the request's transform
/// places and scales the solids as it does vertices. Colours and texture coordinates are those of
/// the vertices at both ends; normals are those of the round surface. All solids of a mesh are as
/// fine as 2^20 triangles allow; distances from a point to the facets of its sphere are within 10 %
/// of the radius, and within 0.8 % up to 2048 points. Points and lines with indices out of range,
/// or vertices that are not finite, are dropped and counted.
void appendSolids(const std::vector<PointOrLine>& solids, const osg::Geometry& geometry,
                  const MeshRequest& request, Mesh& mesh, ConversionCounts& counts);

/// Leads from the vertices of appended solids back to the primitives.
class SolidNumbers
{
public:
    SolidNumbers(const std::vector<PointOrLine>& solids, const osg::Geometry& geometry);

    /// Returns the number of vertices that appendSolids appends.
    std::size_t vertexCount() const { return _firstVertices.back(); }

    /// Returns the primitive to which the n-th of these vertices belongs.
    uint32_t primitiveOf(std::size_t vertex) const;

private:
    std::vector<std::size_t> _firstVertices; // of each solid, and the end of the last one
    std::vector<uint32_t> _primitives;
};

} // namespace osgRayTrace::engine
