// SceneRoot.h - the node that stands for a RayTracedScene in its drawable. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>

namespace osgRayTrace::engine
{

/// Stands for the decorator without being it, so that the drawable neither owns its own owner nor
/// meets itself below. The children do not get this node as a parent: their parents and their paths
/// stay as they are.
class SceneRoot : public osg::Group
{
public:
    explicit SceneRoot(osg::Group* owner) : _owner(owner) {}
    META_Node(osgRayTrace, SceneRoot);

    /// Visits the owner itself, with its state and mask.
    void traverse(osg::NodeVisitor& visitor) override
    {
        if (_owner) _owner->accept(visitor);
    }

    osg::BoundingSphere computeBound() const override
    {
        return _owner ? _owner->osg::Group::computeBound() : osg::BoundingSphere();
    }

    /// Forgets the owner, which calls this when it is destroyed; others may keep the drawable.
    void detach() { _owner = nullptr; }

private:
    SceneRoot() = default;
    SceneRoot(const SceneRoot& other, const osg::CopyOp& copyop) : osg::Group(other, copyop) {}

    osg::Group* _owner = nullptr; // owner, which owns this node indirectly
};

} // namespace osgRayTrace::engine
