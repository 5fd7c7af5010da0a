// DrawHint.h - the hint of a node's author that tells who draws the node. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>

namespace osgRayTrace::engine
{

/// Names the hints. A hint is kept in a node's descriptions, which OSG copies and saves with the
/// node: "osgRayTrace:trace", "osgRayTrace:rasterize", "osgRayTrace:rasterize-only",
/// "osgRayTrace:automatic".
enum class DrawHint
{
    None,      ///< hint of the node above
    Automatic, ///< chosen by the kind of node
    Trace,
    Rasterize,
    RasterizeOnly ///< as Rasterize, without a proxy: see Proxies.h
};

/// Returns whether OSG draws what has the hint.
inline bool leavesToOsg(DrawHint hint)
{
    return hint == DrawHint::Rasterize || hint == DrawHint::RasterizeOnly;
}

/// Returns the hint that the node itself carries. An unknown word is reported once and counts as
/// None.
DrawHint ownHint(const osg::Node& node);

/// Returns the hint of the last node of the path that carries one; None if there is none.
DrawHint hintOf(const osg::NodePath& path);

/// Replaces the node's hint.
void setOwnHint(osg::Node& node, DrawHint hint);

} // namespace osgRayTrace::engine
