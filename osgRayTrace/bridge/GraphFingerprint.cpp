// GraphFingerprint.cpp - a cheap check whether a scene graph has changed. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/GraphFingerprint.h"

#include "osgRayTrace/bridge/GraphCollector.h"
#include "osgRayTrace/bridge/StateFingerprint.h"

#include <osgRayTrace/AreaLight>

#include <osg/Geometry>
#include <osg/LightSource>
#include <osg/NodeVisitor>
#include <osg/Transform>

namespace osgRayTrace::engine
{

namespace
{

/// Follows the children that are active for the eye, as the conversion does.
class FingerprintVisitor : public osg::NodeVisitor
{
public:
    FingerprintVisitor(const ViewingConditions& conditions, const osg::Matrixd& sceneFromLocal)
        : osg::NodeVisitor(NODE_VISITOR, TRAVERSE_ACTIVE_CHILDREN),
          _eye(conditions.eye),
          _sceneFromLocal(sceneFromLocal)
    {
        setTraversalMask(conditions.traversalMask);
        for (const osg::ref_ptr<const osg::StateSet>& stateSet : conditions.inheritedState)
            addStateSet(_digest, *stateSet);
    }

    uint64_t value() const { return _digest.value(); }

    void apply(osg::Node& node) override
    {
        if (const auto* light = dynamic_cast<const AreaLight*>(&node))
            _digest.add(light->getCorner(), light->getEdgeU(), light->getEdgeV(),
                        light->getRadiance(), light->getTwoSided());
        enter(node);
    }

    void apply(osg::Group& node) override { enter(node); }

    void apply(osg::LightSource& node) override
    {
        _digest.add(node.getReferenceFrame());
        if (node.getLight()) addLight(_digest, *node.getLight());
        enter(node);
    }

    void apply(osg::Transform& node) override
    {
        const osg::Matrixd outer = _sceneFromLocal;
        node.computeLocalToWorldMatrix(_sceneFromLocal, this);
        _digest.addMatrix(_sceneFromLocal);
        enter(node);
        _sceneFromLocal = outer;
    }

    void apply(osg::Drawable& drawable) override
    {
        addDrawable(drawable);
        traverse(drawable);
    }

    void apply(osg::Geometry& geometry) override
    {
        addDrawable(geometry);
        _arrays.clear();
        geometry.getArrayList(_arrays);
        for (const auto& array : _arrays)
            _digest.add(array.get(), array->getModifiedCount(), array->getNumElements(),
                        array->getBinding());
        for (const auto& primitives : geometry.getPrimitiveSetList())
            _digest.add(primitives.get(), primitives->getModifiedCount(), primitives->getMode(),
                        primitives->getNumIndices());
        traverse(geometry);
    }

    float getDistanceToEyePoint(const osg::Vec3& point, bool) const override
    {
        return static_cast<float>((osg::Vec3d(point) * _sceneFromLocal - _eye).length());
    }

    float getDistanceToViewPoint(const osg::Vec3& point, bool useLodScale) const override
    {
        return getDistanceToEyePoint(point, useLodScale);
    }

private:
    void enter(osg::Node& node)
    {
        _digest.add(&node);
        addStateSetOf(node);
        if (getNodePath().size() < kDeepestPath) traverse(node);
        _digest.add(kEnd);
    }

    void addDrawable(const osg::Drawable& drawable)
    {
        _digest.add(&drawable);
        addStateSetOf(drawable);
        const osg::BoundingBox& box = drawable.getBoundingBox();
        _digest.add(box._min, box._max);
    }

    void addStateSetOf(const osg::Node& node)
    {
        _digest.add(node.getStateSet());
        if (node.getStateSet()) addStateSet(_digest, *node.getStateSet());
    }

    static constexpr int kEnd = -1; // of the children: a node that moves one level up must show

    Digest _digest;
    osg::Vec3d _eye;
    osg::Matrixd _sceneFromLocal;
    osg::Geometry::ArrayList _arrays;
};

} // namespace

uint64_t graphFingerprint(osg::Node& root, const ViewingConditions& conditions,
                          const osg::Matrixd& sceneFromLocal)
{
    FingerprintVisitor visitor(conditions, sceneFromLocal);
    root.accept(visitor);
    return visitor.value();
}

} // namespace osgRayTrace::engine
