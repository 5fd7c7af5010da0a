// RasterizedParts.h - the parts that a traced scene leaves to OSG to draw. Layer: bridge.
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

/// Names a drawable, camera or other node of the graph that is drawn as without ray tracing. A part
/// may also be positional state (a light, clip planes, generated texture coordinates) that such a
/// node may need.
struct RasterizedPart
{
    enum Kind
    {
        Draw,
        Clear, ///< an osg::ClearNode, with which the picture begins
        PlaceState
    };

    Kind kind = Draw;
    /// Path from below the decorator to the node itself; a part that held its owner would never be
    /// freed.
    std::vector<osg::ref_ptr<osg::Node>> path;
    /// Node that is drawn in place of the last of path; may be null.
    osg::ref_ptr<osg::Node> inPlace;
};

/// Lists parts in the order of the traversal. The list is immutable once it is published.
using RasterizedParts = std::vector<RasterizedPart>;

/// Returns the rest of a geometry whose triangles are traced, and its points and lines if there is
/// a radius for them: a shallow copy, which shares the arrays. Null: there is no rest.
osg::ref_ptr<osg::Geometry> untracedSets(const osg::Geometry& geometry, float pointRadius);

/// Returns a part for the last node of this path, which begins with the node that stands for the
/// decorator and with the decorator.
RasterizedPart rasterizedPart(RasterizedPart::Kind kind, const osg::NodePath& path);

/// Culls the parts as their parents would: with the state, the transforms and the masks on their
/// paths, from the decorator on, at which the visitor is. Cull callbacks of groups on the way are
/// not called. The graph is not changed. Cull threads call this.
void cullParts(const RasterizedParts& parts, osgUtil::CullVisitor& visitor);

} // namespace osgRayTrace::engine
