// VertexArrays.h - the vertex data of a geometry. Layer: bridge.
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
    SharedArray<Vec3> values;     ///< finite: what was not is 0 here
    std::vector<uint8_t> unsound; ///< one a position: not finite or too large; empty: none is
};

struct Normals
{
    SharedArray<Vec3> values;     ///< unit; empty: the geometry has none
    std::vector<uint8_t> missing; ///< one a normal: to be replaced; empty: none is
};

/// Reads a geometry's arrays by OpenGL's rules for MeshRequest's transform; shares them where
/// allowed.
class VertexReader
{
public:
    VertexReader(const osg::Geometry& geometry, const MeshRequest& request, const VertexMap& map)
        : _geometry(geometry), _request(request), _map(map)
    {
    }

    /// The array is readable.
    Positions positions(const osg::Array& array) const;

    // Any array, null too: then the result is empty.

    Normals normals(const osg::Array* array) const;

    /// s/q and t/q. Counts repaired coordinates.
    SharedArray<Vec2> textureCoordinates(const osg::Array* array, ConversionCounts& counts) const;

    /// r/q; empty if all of them are 0, as they are where arrays have two components.
    SharedArray<float> thirdCoordinates(const osg::Array* array) const;

    /// Only colours that vary: a single one is part of the material. Counts repaired colours.
    SharedArray<Vec4> colors(const osg::Array* array, ConversionCounts& counts) const;

private:
    template <class T> const T* shareable(const osg::Array& array) const;
    template <class T> SharedArray<T> share(const osg::Array& array) const;
    RowSelection rowsOfBinding(const osg::Array& array, IntegerMeaning integers) const;

    const osg::Geometry& _geometry;
    const MeshRequest& _request;
    const VertexMap& _map;
};

} // namespace osgRayTrace::engine
