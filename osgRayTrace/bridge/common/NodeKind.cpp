// NodeKind.cpp - tells the class of a node, without a virtual call for frequent classes. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/NodeKind.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/EnvironmentLight>
#include <osgRayTrace/MediumVolume>
#include <osgRayTrace/RayTracedScene>

#include <osg/ClipNode>
#include <osg/Geode>
#include <osg/LightSource>
#include <osg/MatrixTransform>
#include <osg/PositionAttitudeTransform>
#include <osg/ShapeDrawable>
#include <osg/Switch>

#include <typeinfo>

namespace osgRayTrace::engine
{

namespace
{

/// Returns whether the node is the library's own decorator, a plain group for this traversal.
bool isDecorator(const osg::Node& node)
{
    return typeid(node) == typeid(RayTracedScene);
}

struct GroupChildren : osg::Group
{
    static const osg::NodeList& of(const osg::Group& group)
    {
        return group.*(&GroupChildren::_children);
    }
};

} // namespace

NodeKind kindOf(const osg::Node& node)
{
    const std::type_info& type = typeid(node);
    if (type == typeid(osg::Geometry) || type == typeid(osg::ShapeDrawable))
        return NodeKind::Geometry;
    const osg::Transform* transform = node.asTransform();
    if (transform && transform->getReferenceFrame() != osg::Transform::RELATIVE_RF)
        return NodeKind::Untracked; // the node's place depends on the view
    if (type == typeid(osg::MatrixTransform)) return NodeKind::MatrixTransform;
    if (type == typeid(osg::PositionAttitudeTransform)) return NodeKind::PositionAttitudeTransform;
    if (type == typeid(osg::Group) || type == typeid(osg::Geode)) return NodeKind::Group;
    if (type == typeid(osg::Switch)) return NodeKind::Switch;
    if (type == typeid(osg::LightSource)) return NodeKind::Light;
    if (type == typeid(osg::ClipNode)) return NodeKind::Clip;
    if (type == typeid(AreaLight)) return NodeKind::AreaLight;
    if (type == typeid(EnvironmentLight)) return NodeKind::Environment;
    if (type == typeid(MediumVolume))
        return static_cast<const MediumVolume&>(node).getShape() == MediumVolume::BOX
                   ? NodeKind::Untracked // it is converted as a mesh
                   : NodeKind::Volume;
    return isDecorator(node) ? NodeKind::Group : NodeKind::Untracked;
}

const osg::NodeList& childrenOf(const osg::Group& group)
{
    return GroupChildren::of(group);
}

bool isOn(NodeKind kind, const osg::Group& group, unsigned int child)
{
    return kind != NodeKind::Switch || static_cast<const osg::Switch&>(group).getValue(child);
}

} // namespace osgRayTrace::engine
