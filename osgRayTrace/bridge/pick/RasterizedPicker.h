// RasterizedPicker.h - osgUtil's own intersections with what is not ray traced. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/pick/PickIndex.h"

#include <osgUtil/LineSegmentIntersector>

namespace osgRayTrace::engine
{

/// The segment against the parts of the index that the visitor, which is at the decorator, may
/// visit: with its masks, matrices and choices. Throws std::bad_alloc.
std::vector<osgUtil::LineSegmentIntersector::Intersection>
pickRasterized(const PickIndex& index, osgUtil::IntersectionVisitor& visitor,
               const osgUtil::LineSegmentIntersector& segment);

} // namespace osgRayTrace::engine
