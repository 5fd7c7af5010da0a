// TracedRoot.cpp - the decorator between a node and its parents. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "TracedRoot.h"

namespace osgRayTrace::calvr
{

TracedRoot::TracedRoot(RayTraceSettings* settings) : _scene(new RayTracedScene)
{
    _scene->setName("osgRayTrace");
    _scene->setSettings(settings);
}

TracedRoot::~TracedRoot()
{
    switchOff();
}

void TracedRoot::switchOn(osg::Group* root)
{
    if (isOn() || !root || root->getNumParents() == 0) return;
    _root = root;
    _scene->setCullingActive(root->getCullingActive());
    const osg::Node::ParentList parents = root->getParents();
    for (osg::Group* parent : parents)
        parent->replaceChild(root, _scene);
    _scene->insertChild(0, root);
    _scene->setEnabled(true); // tries again what failed
}

void TracedRoot::switchOff()
{
    if (!isOn()) return;
    const osg::ref_ptr<osg::Group> root = _root;
    _root = nullptr;
    _scene->removeChild(root);
    const osg::Node::ParentList parents = _scene->getParents();
    for (osg::Group* parent : parents)
        parent->replaceChild(_scene, root);
}

void TracedRoot::updateLights(const osg::Group& room, const osg::Matrixd& rootFromRoom)
{
    if (isOn()) _lights.update(room, rootFromRoom, *_scene);
}

} // namespace osgRayTrace::calvr
