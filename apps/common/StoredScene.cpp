// StoredScene.cpp - finds the ray traced scene that a model brings with it. Layer: apps.
// SPDX-License-Identifier: MIT
#include "StoredScene.h"

#include <osg/NodeVisitor>

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
        if (!found) traverse(node);
    }

    osg::ref_ptr<RayTracedScene> found;
};

} // namespace

osg::ref_ptr<RayTracedScene> storedScene(osg::Node& model)
{
    FindTracedScene find;
    model.accept(find);
    return find.found;
}

} // namespace osgRayTrace::app
