// RasterizedParts.h - the parts that a traced scene leaves to OSG to draw. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>
#include <osg/Node>

#include <memory>
#include <optional>
#include <unordered_set>
#include <vector>

namespace osgUtil
{
class CullVisitor;
}

namespace osgRayTrace::engine
{

/// Holds drawables that are traced among those of a subtree that OSG culls. State graphs that refer
/// to it keep it alive.
struct TracedLeaves : osg::Referenced
{
    std::vector<osg::ref_ptr<osg::Drawable>> kept;
    std::unordered_set<const osg::Drawable*> drawables;
    bool made = false; ///< true: so are all geometries of the subtree that are of no node
    /// State set without state, below which the state graph holds what is drawn of the subtree.
    osg::ref_ptr<osg::StateSet> mark = new osg::StateSet;
};

/// Holds what decides on a geometry that OSG draws, as far as it depends on state: if both stay,
/// nothing that is traced changes.
struct LeftState
{
    const char* reason = nullptr; ///< see rasterizedState; null: another rule leaves it to OSG
    bool proxied = false;         ///< see hasProxy
};

/// Names a drawable, camera or other node of the graph that is drawn as without ray tracing. A part
/// may also be positional state (a light, clip planes, generated texture coordinates) that such a
/// node may need.
struct RasterizedPart
{
    enum Kind
    {
        Draw,
        Clear, ///< an osg::ClearNode, with which the picture begins
        PlaceState,
        Pick ///< nothing is drawn: the leaves of the node's cull traversal are traced
    };

    Kind kind = Draw;
    /// Path from below the decorator to the node itself; a part that held its owner would never be
    /// freed.
    std::vector<osg::ref_ptr<osg::Node>> path;
    /// Node that is drawn in place of the last of path; may be null.
    osg::ref_ptr<osg::Node> inPlace;
    osg::ref_ptr<TracedLeaves> traced; ///< leaves that are not drawn; null: none
    std::optional<LeftState> left;     ///< of a geometry that OSG draws for its state; else none
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
/// not called: those that add anything are part of what is culled (see CullOutcome). The graph is
/// not changed. Cull threads call this.
void cullParts(const RasterizedParts& parts, osgUtil::CullVisitor& visitor);

} // namespace osgRayTrace::engine
