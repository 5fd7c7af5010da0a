// NodeKind.h - the classes of nodes whose values are known one by one. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>

#include <cstdint>

namespace osgRayTrace::engine
{

/// Classes whose values are known one by one.
enum class NodeKind : uint8_t
{
    Group,
    Switch,
    MatrixTransform,
    PositionAttitudeTransform,
    Light, ///< the last that is a group
    AreaLight,
    Environment,
    Geometry,
    Untracked, ///< any other class, with all that is below it: see graphHash
};

/// By the class itself: one derived from it may do anything. What a conversion makes of each class
/// is in GraphCollector::apply(), which must read no more of a node than NodeHashes.cpp hashes for
/// its kind; all other classes are Untracked.
NodeKind kindOf(const osg::Node& node);

inline bool isTransform(NodeKind kind)
{
    return kind == NodeKind::MatrixTransform || kind == NodeKind::PositionAttitudeTransform;
}

inline bool isLight(NodeKind kind)
{
    return kind == NodeKind::Light || kind == NodeKind::AreaLight || kind == NodeKind::Environment;
}

/// osg::Group shows them one by one only, by virtual calls.
const osg::NodeList& childrenOf(const osg::Group& group);

/// Whether a group has this child active; masks apart.
bool isOn(NodeKind kind, const osg::Group& group, unsigned int child);

} // namespace osgRayTrace::engine
