// MovedTangents.h - tangents of geometry whose vertices osgAnimation moves. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>

namespace osgRayTrace::engine
{

/// Returns the tangents of a geometry as its vertices stand now; null if there are none, or if they
/// are those of vertices that have moved since, so that new ones have to be made
/// (VertexTangents.h). osgAnimation moves positions and normals alone. Here, vertex attribute 6 of
/// a morph's targets moves the tangents by the same weights and method: three or four floats a
/// vertex, of which a fourth does nothing. deforms: the vertices of the geometry are known to move.
osg::ref_ptr<const osg::Array> tangentsNow(const osg::Geometry& geometry, bool deforms);

} // namespace osgRayTrace::engine
