// PickMode.h - what a pick costs. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

namespace osgRayTrace::bench
{

/// Random segments through a sphere of a million triangles and through a field of 10,000 objects
/// with transforms: RayIntersector against osgUtil::LineSegmentIntersector with and without
/// osg::KdTree, and against the ray alone. On one thread, by its own time.
void measurePicks(Rows& rows);

} // namespace osgRayTrace::bench
