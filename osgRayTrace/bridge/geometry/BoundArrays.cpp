// BoundArrays.cpp - finds the bindings of arrays. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/BoundArrays.h"

#include "osgRayTrace/bridge/common/ArrayReader.h"

namespace osgRayTrace::engine
{

osg::Array::Binding bindingOf(const osg::Array* array)
{
    if (!isReadable(array)) return osg::Array::BIND_OFF;
    switch (array->getBinding())
    {
    case osg::Array::BIND_OVERALL:
    case osg::Array::BIND_PER_PRIMITIVE_SET:
    case osg::Array::BIND_PER_VERTEX:
        return array->getBinding();
    default:
        return osg::Array::BIND_OFF;
    }
}

const osg::Array* positionArray(const osg::Geometry& geometry)
{
    if (geometry.getVertexArray()) return geometry.getVertexArray();
    return geometry.getNumVertexAttribArrays() > 0 ? geometry.getVertexAttribArray(0) : nullptr;
}

const osg::Array* tangentArray(const osg::Geometry& geometry)
{
    constexpr unsigned int kTangents = 6;
    return geometry.getNumVertexAttribArrays() > kTangents
               ? geometry.getVertexAttribArray(kTangents)
               : nullptr;
}

} // namespace osgRayTrace::engine
