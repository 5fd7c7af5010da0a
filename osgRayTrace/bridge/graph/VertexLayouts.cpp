// VertexLayouts.cpp - makes stand-ins that share the arrays of their originals. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/VertexLayouts.h"

#include "osgRayTrace/bridge/geometry/BoundArrays.h"

#include <algorithm>
#include <iterator>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the array of an attribute, or the fixed one without it. The arrays are shared, but not
/// changed.
osg::Array* arrayOf(const osg::Geometry& geometry, int attribute, const osg::Array* fixed)
{
    const osg::Array* own =
        attribute >= 0 ? geometry.getVertexAttribArray(static_cast<unsigned int>(attribute))
                       : nullptr;
    return const_cast<osg::Array*>(own ? own : fixed);
}

void copyPrimitives(const osg::Geometry& from, osg::Geometry& to)
{
    if (to.getPrimitiveSetList() == from.getPrimitiveSetList()) return;
    to.setPrimitiveSetList(from.getPrimitiveSetList());
}

} // namespace

const osg::Geometry& VertexLayouts::laidOut(const osg::Geometry& geometry,
                                            const VertexAttributes& attributes, unsigned int unit)
{
    osg::Array* positions = arrayOf(geometry, attributes.position, geometry.getVertexArray());
    osg::Array* normals = arrayOf(geometry, attributes.normal, geometry.getNormalArray());
    const osg::Array* ofUnit = geometry.getTexCoordArray(unit);
    osg::Array* coordinates =
        arrayOf(geometry, attributes.texcoord, ofUnit ? ofUnit : geometry.getTexCoordArray(0));
    if (positions == geometry.getVertexArray() && normals == geometry.getNormalArray() &&
        coordinates == geometry.getTexCoordArray(0))
        return geometry;

    StandIn& standIn =
        _standIns[{&geometry, attributes.position, attributes.normal, attributes.texcoord, unit}];
    standIn.used = _round;
    if (!standIn.geometry)
    {
        standIn.original = &geometry;
        standIn.geometry = new osg::Geometry;
    }
    osg::Geometry& result = *standIn.geometry;
    result.setName(geometry.getName());
    result.setDataVariance(geometry.getDataVariance());
    result.setVertexArray(positions);
    result.setNormalArray(normals);
    result.setColorArray(const_cast<osg::Array*>(geometry.getColorArray()));
    result.setTexCoordArray(0, coordinates);
    for (unsigned int i = 1; i < std::max(geometry.getNumTexCoordArrays(), 2u); ++i)
        result.setTexCoordArray(i, const_cast<osg::Array*>(geometry.getTexCoordArray(i)));
    if (!positions) // attribute 0 holds the positions then
        result.setVertexAttribArray(0, const_cast<osg::Array*>(geometry.getVertexAttribArray(0)));
    if (const osg::Array* tangents = tangentArray(geometry))
        result.setVertexAttribArray(6, const_cast<osg::Array*>(tangents));
    copyPrimitives(geometry, result);
    return result;
}

void VertexLayouts::end()
{
    for (auto standIn = _standIns.begin(); standIn != _standIns.end();)
        standIn = standIn->second.used != _round ? _standIns.erase(standIn) : std::next(standIn);
}

} // namespace osgRayTrace::engine
