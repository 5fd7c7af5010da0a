// PolygonCutter.h - cuts the concave polygons of one geometry. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ArrayReader.h"
#include "osgRayTrace/bridge/geometry/BoundArrays.h"
#include "osgRayTrace/bridge/geometry/PolygonTriangles.h"

#include <osg/Geometry>

#include <vector>

namespace osgRayTrace::engine
{

/// Reads the vertices of a geometry when its first polygon comes.
class PolygonCutter
{
public:
    PolygonCutter(const osg::Geometry& geometry, std::size_t vertexCount)
        : _geometry(geometry), _vertexCount(vertexCount)
    {
    }

    /// Appends the triangles of a concave polygon of the vertices index(0), index(1), ... Returns
    /// false if a fan of triangles is right.
    template <class Index>
    bool append(std::size_t count, const Index& index, std::vector<UVec3>& triangles)
    {
        if (count < 4 || count > kMostCorners) return false;
        readPositions();
        std::vector<Vec3d> corners;
        for (std::size_t i = 0; i < count; ++i)
        {
            if (index(i) >= _positions.size()) return false;
            corners.push_back(_positions[index(i)]);
        }
        const std::vector<UVec3> cut = concavePolygonTriangles(corners);
        for (const UVec3& t : cut)
            triangles.emplace_back(index(t.x), index(t.y), index(t.z));
        return !cut.empty();
    }

private:
    void readPositions()
    {
        if (!_positions.empty()) return;
        _positions.resize(_vertexCount);
        forEachRow(*positionArray(_geometry), {_vertexCount},
                   [&](std::size_t i, const Vec4d& row) { _positions[i] = Vec3d(row) / row.w; });
    }

    const osg::Geometry& _geometry;
    std::size_t _vertexCount;
    std::vector<Vec3d> _positions;
};

} // namespace osgRayTrace::engine
