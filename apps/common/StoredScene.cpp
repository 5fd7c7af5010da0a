// StoredScene.cpp - visits the nodes of a model, each once. Layer: apps.
// SPDX-License-Identifier: MIT
#include "StoredScene.h"

#include <osg/NodeVisitor>

#include <set>

namespace osgRayTrace::app
{

namespace
{

struct FindTracedScene : osg::NodeVisitor
{
    FindTracedScene() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Group& node) override
    {
        if (!found) found = dynamic_cast<RayTracedScene*>(&node);
        if (!found && visited.insert(&node).second) traverse(node); // one path is enough
    }

    osg::ref_ptr<RayTracedScene> found;
    std::set<osg::ref_ptr<osg::Group>> visited;
};

} // namespace

osg::ref_ptr<RayTracedScene> storedScene(osg::Node& model)
{
    FindTracedScene find;
    model.accept(find);
    return find.found;
}

} // namespace osgRayTrace::app
