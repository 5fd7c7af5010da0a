// RasterizedPicker.h - osgUtil's own intersections with the parts that are not ray traced. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/pick/PickIndex.h"

#include <osgUtil/LineSegmentIntersector>

namespace osgRayTrace::engine
{

/// Intersects the segment with those parts of the index that the visitor, which is at the
/// decorator, may visit, with its masks, matrices and choices. Throws std::bad_alloc.
std::vector<osgUtil::LineSegmentIntersector::Intersection>
pickRasterized(const PickIndex& index, osgUtil::IntersectionVisitor& visitor,
               const osgUtil::LineSegmentIntersector& segment);

} // namespace osgRayTrace::engine
