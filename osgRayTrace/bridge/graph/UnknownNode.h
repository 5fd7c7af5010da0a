// UnknownNode.h - which nodes GraphWatch does not know one by one. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/NodeKind.h"
#include "osgRayTrace/bridge/common/SceneRoot.h"

#include <typeinfo>

namespace osgRayTrace::engine
{

/// Returns whether a node is of an unknown class; SceneRoot stands for the decorator, and is none.
inline bool isUnknown(const osg::Node& node)
{
    return kindOf(node) == NodeKind::Untracked && typeid(node) != typeid(SceneRoot);
}

} // namespace osgRayTrace::engine
