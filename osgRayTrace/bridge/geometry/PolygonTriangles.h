// PolygonTriangles.h - a concave polygon cut into triangles. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <vector>

namespace osgRayTrace::engine
{

/// The corners of corners.size() - 2 triangles, in the polygon's own sense of rotation. Empty: the
/// triangle fan that OpenGL draws is right, or there is nothing better: the outline cuts itself, is
/// not finite, or has more than kMostCorners.
std::vector<UVec3> concavePolygonTriangles(const std::vector<Vec3d>& corners);

/// The time to cut a polygon may grow with the third power of its corners.
constexpr std::size_t kMostCorners = 512;

} // namespace osgRayTrace::engine
