// GeometryGenerator.h - geometries that OpenGL and the converter should refuse, and some that are
// right. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "FuzzSeeds.h"

#include <osg/Geometry>

namespace osgRayTrace::test
{

/// Returns any primitive sets over any arrays: sizes, types, bindings, indices and values may be
/// wrong.
osg::ref_ptr<osg::Geometry> randomGeometry(Dice& dice);

/// Returns the number of triangles that OpenGL makes of the geometry's primitive sets, whatever
/// their indices; it is counted in another way than the converter counts.
uint64_t trianglesOfSets(const osg::Geometry& geometry);

} // namespace osgRayTrace::test
