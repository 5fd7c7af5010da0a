// PickMode.h - the cost of a pick. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

namespace osgRayTrace::bench
{

/// Measures random segments through a sphere of a million triangles and through a field of 10,000
/// objects with transforms: RayIntersector against osgUtil::LineSegmentIntersector with and without
/// osg::KdTree, and against the ray alone. Times are one thread's own.
void measurePicks(Rows& rows);

} // namespace osgRayTrace::bench
