// BoundArrays.h - how arrays of a geometry are bound, and which one holds its positions. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>

namespace osgRayTrace::engine
{

/// How an array is bound, by what OSG 3.6 does with it: off if it cannot be read.
osg::Array::Binding bindingOf(const osg::Array* array);

/// The array that holds the positions: the vertex array or, without one, vertex attribute 0. May be
/// null.
const osg::Array* positionArray(const osg::Geometry& geometry);

} // namespace osgRayTrace::engine
