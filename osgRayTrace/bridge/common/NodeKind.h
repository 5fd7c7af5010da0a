// NodeKind.h - the classes of nodes whose values are known one by one. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>

#include <cstdint>

namespace osgRayTrace::engine
{

/// Names the classes whose values are known one by one.
enum class NodeKind : uint8_t
{
    Group,
    Switch,
    MatrixTransform,
    PositionAttitudeTransform,
    Light,
    Clip, ///< the last kind that is a group
    AreaLight,
    Environment,
    Volume, ///< a MediumVolume, which changes as lights do
    Geometry,
    Untracked, ///< any other class, with all nodes below: see graphHash
};

/// Returns the kind by the exact class, because a derived class may do anything.
NodeKind kindOf(const osg::Node& node);

inline bool isTransform(NodeKind kind)
{
    return kind == NodeKind::MatrixTransform || kind == NodeKind::PositionAttitudeTransform;
}

inline bool isLight(NodeKind kind)
{
    return kind == NodeKind::Light || kind == NodeKind::AreaLight ||
           kind == NodeKind::Environment || kind == NodeKind::Volume;
}

/// Returns the children as a list; osg::Group has only virtual calls for one child at a time.
const osg::NodeList& childrenOf(const osg::Group& group);

/// Returns whether a group has this child active; masks do not count.
bool isOn(NodeKind kind, const osg::Group& group, unsigned int child);

} // namespace osgRayTrace::engine
