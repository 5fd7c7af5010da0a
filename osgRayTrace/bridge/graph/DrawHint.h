// DrawHint.h - what a node's author says about who draws it. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>

namespace osgRayTrace::engine
{

/// Kept in a node's descriptions, which OSG copies and saves with it: "osgRayTrace:trace",
/// "osgRayTrace:rasterize", "osgRayTrace:automatic".
enum class DrawHint
{
    None,      ///< as the node above
    Automatic, ///< by what it is
    Trace,
    Rasterize
};

/// That the node itself carries; one that is no word of these is said once and None.
DrawHint ownHint(const osg::Node& node);

/// Of the last node of the path that carries one; None if there is none.
DrawHint hintOf(const osg::NodePath& path);

/// Replaces that of the node.
void setOwnHint(osg::Node& node, DrawHint hint);

} // namespace osgRayTrace::engine
