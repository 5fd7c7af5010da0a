// VertexArrays.h - reads the vertex data of a geometry. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/SharedArray.h"
#include "osgRayTrace/bridge/common/ArrayReader.h"
#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/bridge/geometry/BoundArrays.h"
#include "osgRayTrace/bridge/geometry/MeshRequest.h"
#include "osgRayTrace/bridge/geometry/VertexMap.h"

#include <osg/Array>

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

struct Positions
{
    SharedArray<Vec3> values; ///< finite positions; 0 in place of values that were not finite
    /// 1 for each position that was not finite or is too large; empty: none.
    std::vector<uint8_t> unsound;
};

struct Normals
{
    SharedArray<Vec3> values;     ///< unit normals; empty: the geometry has none
    std::vector<uint8_t> missing; ///< 1 for each normal that has to be replaced; empty: none
};

/// Reads a geometry's arrays by OpenGL's rules for MeshRequest's transform, and shares them if that
/// is allowed.
class VertexReader
{
public:
    VertexReader(const osg::Geometry& geometry, const MeshRequest& request, const VertexMap& map)
        : _geometry(geometry), _request(request), _map(map)
    {
    }

    /// Returns the positions of an array, which must be readable.
    Positions positions(const osg::Array& array) const;

    // Returns the normals of any array; null gives an empty result.

    Normals normals(const osg::Array* array) const;

    /// Returns s/q and t/q. Counts repaired coordinates.
    SharedArray<Vec2> textureCoordinates(const osg::Array* array, ConversionCounts& counts) const;

    /// Returns r/q; the result is empty if all values are 0, as for arrays of two components.
    SharedArray<float> thirdCoordinates(const osg::Array* array) const;

    /// Returns the colours if they vary, because a single colour is part of the material. Counts
    /// repaired colours.
    SharedArray<Vec4> colors(const osg::Array* array, ConversionCounts& counts) const;

    /// Returns tangents with the signs of their bitangents; the result is empty unless the array
    /// has four components a vertex.
    SharedArray<Vec4> tangents(const osg::Array* array) const;

private:
    template <class T> const T* shareable(const osg::Array& array) const;
    template <class T> SharedArray<T> share(const osg::Array& array) const;
    RowSelection rowsOfBinding(const osg::Array& array, IntegerMeaning integers) const;

    const osg::Geometry& _geometry;
    const MeshRequest& _request;
    const VertexMap& _map;
};

} // namespace osgRayTrace::engine
