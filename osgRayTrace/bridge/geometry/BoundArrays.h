// BoundArrays.h - the binding of a geometry's arrays, and the array of its positions. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>

namespace osgRayTrace::engine
{

/// Returns how OSG 3.6 binds an array: off if the array cannot be read.
osg::Array::Binding bindingOf(const osg::Array* array);

/// Returns the array that holds the positions: the vertex array or, without one, vertex attribute
/// 0. The result may be null.
const osg::Array* positionArray(const osg::Geometry& geometry);

/// Returns vertex attribute 6, in which tangents stand; null if there is none.
const osg::Array* tangentArray(const osg::Geometry& geometry);

} // namespace osgRayTrace::engine
