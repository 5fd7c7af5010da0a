// NodePathText.h - a node path as reports and messages name it. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>

#include <string>

namespace osgRayTrace::engine
{

/// "root/arm/Geometry": the name of each node, or its class if it has no name.
inline std::string pathText(const osg::NodePath& path)
{
    std::string text;
    for (const osg::Node* node : path)
    {
        if (!text.empty()) text += '/';
        text += node->getName().empty() ? node->className() : node->getName();
    }
    return text;
}

} // namespace osgRayTrace::engine
