// PolygonTriangles.h - cuts a concave polygon into triangles. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Returns the corners of corners.size() - 2 triangles, in the polygon's own sense of rotation. The
/// result is empty if the triangle fan that OpenGL draws is right, or if nothing better exists: the
/// outline cuts itself, is not finite, or has more than kMostCorners.
std::vector<UVec3> concavePolygonTriangles(const std::vector<Vec3d>& corners);

/// Largest number of corners of a polygon that is cut, as the time may grow with the third power of
/// the corners.
constexpr std::size_t kMostCorners = 512;

} // namespace osgRayTrace::engine
