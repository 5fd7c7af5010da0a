// TriangleCollector.h - the triangles of the primitive sets of a geometry. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/geometry/TriangleList.h"

#include <osg/Geometry>

#include <cstddef>

namespace osgRayTrace::engine
{

/// Returns the triangles of triangle lists, strips, fans, quads, quad strips and polygons of
/// DrawArrays, MultiDrawArrays, DrawArrayLengths and DrawElements. Sets of other kinds are counted.
/// Concave polygons are cut into triangles; OpenGL leaves their result open and draws fans. If
/// numbered is true, the list has the numbers of primitives, and source is not set.
TriangleList trianglesOf(const osg::Geometry& geometry, std::size_t vertexCount,
                         const PrimitiveRestart& restart, bool numbered = false);

} // namespace osgRayTrace::engine
