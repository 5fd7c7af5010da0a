// PlacedState.h - lights, clip planes and the like of a node, without its children. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>

namespace osgUtil
{
class CullVisitor;
}

namespace osgRayTrace::engine
{

/// Places the state of a node, as CullVisitor does on its way to the node's children: a light, clip
/// planes, generated texture coordinates, or the colour of a picture that is cleared.
void placeState(const osg::Node& node, osgUtil::CullVisitor& visitor);

} // namespace osgRayTrace::engine
