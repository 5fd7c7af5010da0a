// GeometryGenerator.h - geometries that OpenGL and the converter should refuse, and some that are
// right. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "FuzzSeeds.h"

#include <osg/Geometry>

namespace osgRayTrace::test
{

/// Any primitive sets over any arrays: wrong sizes, types, bindings, indices and values.
osg::ref_ptr<osg::Geometry> randomGeometry(Dice& dice);

/// Triangles that OpenGL makes of the geometry's primitive sets, whatever their indices; found in
/// another way than the converter's.
uint64_t trianglesOfSets(const osg::Geometry& geometry);

} // namespace osgRayTrace::test
