// RasterizedParts.h - what a traced scene leaves to OSG to draw. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>
#include <osg/Node>

#include <memory>
#include <vector>

namespace osgUtil
{
class CullVisitor;
}

namespace osgRayTrace::engine
{

/// A drawable, camera or other node of the graph that is drawn as without ray tracing, or
/// positional state (a light, clip planes, generated texture coordinates) that it may need.
struct RasterizedPart
{
    enum Kind
    {
        Draw,
        Clear, ///< an osg::ClearNode: what the picture begins with
        PlaceState
    };

    Kind kind = Draw;
    /// From below the decorator to the node itself: what holds its owner would never be freed.
    std::vector<osg::ref_ptr<osg::Node>> path;
    osg::ref_ptr<osg::Node> inPlace; ///< drawn in place of the last of path; may be null
};

/// In the order of the traversal. Immutable once it is published.
using RasterizedParts = std::vector<RasterizedPart>;

/// The rest of a geometry whose triangles are traced: a shallow copy, so arrays are shared. Null:
/// nothing.
osg::ref_ptr<osg::Geometry> withoutTriangles(const osg::Geometry& geometry);

/// The last node of this path, which begins with what stands for the decorator and the decorator.
RasterizedPart rasterizedPart(RasterizedPart::Kind kind, const osg::NodePath& path);

/// Culls the parts as their parents would: with the state, the transforms and the masks on their
/// paths, from the decorator on, which the visitor is at. Cull callbacks of groups on the way are
/// not called. The graph is not changed. Cull threads.
void cullParts(const RasterizedParts& parts, osgUtil::CullVisitor& visitor);

} // namespace osgRayTrace::engine
