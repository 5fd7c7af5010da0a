// TriangleCollector.h - the triangles of the primitive sets of a geometry. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/geometry/TriangleList.h"

#include <osg/Geometry>

#include <cstddef>

namespace osgRayTrace::engine
{

/// Says what trianglesOf returns beside triangles.
struct ListContents
{
    bool numbered = false; ///< true: the list has the numbers of primitives; source is not set
    bool solids = false;   ///< true: points and lines are in the list, else they are counted
};

/// Returns the triangles of triangle lists, strips, fans, quads, quad strips and polygons of
/// DrawArrays, MultiDrawArrays, DrawArrayLengths and DrawElements. Sets of other kinds are counted.
/// Concave polygons are cut into triangles; OpenGL leaves their result open and draws fans.
TriangleList trianglesOf(const osg::Geometry& geometry, std::size_t vertexCount,
                         const PrimitiveRestart& restart, const ListContents& contents = {});

} // namespace osgRayTrace::engine
