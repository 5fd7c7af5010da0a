// GraphHash.cpp - checks cheaply whether a scene graph has changed. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/GraphHash.h"

#include "osgRayTrace/bridge/changes/NodeHashes.h"
#include "osgRayTrace/bridge/changes/StateHash.h"
#include "osgRayTrace/bridge/common/LibraryName.h"
#include "osgRayTrace/bridge/geometry/BufferContents.h"
#include "osgRayTrace/bridge/graph/DrawHint.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"
#include "osgRayTrace/bridge/graph/SoftwareVertices.h"
#include "osgRayTrace/bridge/graph/UntracedParts.h"
#include "osgRayTrace/bridge/graph/VolumeTiles.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/EnvironmentLight>
#include <osgRayTrace/MediumVolume>

#include <osg/Billboard>
#include <osg/ClearNode>
#include <osg/ClipNode>
#include <osg/Geometry>
#include <osg/LightSource>
#include <osg/NodeVisitor>
#include <osg/TexGenNode>
#include <osg/Transform>

#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

namespace
{

/// Follows the children that are active for the eye, as the conversion does.
class HashVisitor : public osg::NodeVisitor
{
public:
    HashVisitor(const ViewingConditions& conditions, const osg::Matrixd& sceneFromLocal,
                KeptObjects* kept, BufferVersions* versions, PathBudget& budget)
        : osg::NodeVisitor(NODE_VISITOR, TRAVERSE_ACTIVE_CHILDREN),
          _hasher(kept),
          _kept(kept),
          _versions(versions),
          _budget(budget),
          _eye(conditions.eye),
          _view(conditions.view),
          _reads(conditions.reads),
          _hasViewMasks(!conditions.viewMasks.empty()),
          _cullStack(conditions.view),
          _sceneFromLocal(sceneFromLocal)
    {
        setTraversalMask(conditions.traversalMask);
        for (const osg::ref_ptr<const osg::StateSet>& stateSet : conditions.inheritedState)
            addStateSet(_hasher, *stateSet, _reads.get());
    }

    uint64_t value() const { return _hasher.value(); }

    /// Has the hash leave out what structureHash() does not tell.
    void leaveShapesOut() { _shapes = false; }

    /// Has the hash leave it out of these nodes and what is below them.
    void follow(const std::unordered_set<const osg::Node*>* followed) { _followed = followed; }

    void apply(osg::Node& node) override
    {
        addPlace();
        if (const auto* light = dynamic_cast<const AreaLight*>(&node))
            _hasher.add(light->getCorner(), light->getEdgeU(), light->getEdgeV(),
                        light->getRadiance(), light->getTwoSided());
        if (dynamic_cast<const EnvironmentLight*>(&node))
            _hasher.add(lightHash(NodeKind::Environment, node, _kept));
        if (dynamic_cast<const MediumVolume*>(&node))
            _hasher.add(lightHash(NodeKind::Volume, node, _kept));
        enter(node);
    }

    void apply(osg::Group& node) override
    {
        const auto* tile = isFrom(&node, "osgVolume")
                               ? dynamic_cast<const osgVolume::VolumeTile*>(&node)
                               : nullptr;
        if (tile)
        {
            addPlace();
            _hasher.add(volumeHash(*tile));
        }
        enter(node);
    }

    void apply(osg::LightSource& node) override
    {
        addPlace();
        _hasher.add(node.getReferenceFrame());
        if (node.getLight()) addLight(_hasher, *node.getLight());
        enter(node);
    }

    void apply(osg::TexGenNode& node) override
    {
        addPlace();
        if (node.getReferenceFrame() == osg::TexGenNode::ABSOLUTE_RF) hashView();
        _hasher.add(node.getReferenceFrame(), node.getTextureUnit());
        _hasher.addObject(node.getTexGen());
        if (node.getTexGen()) addTexGen(_hasher, *node.getTexGen());
        enter(node);
    }

    void apply(osg::Transform& node) override
    {
        const osg::Matrixd outer = _sceneFromLocal;
        _sceneFromLocal = worldFromLocal(node, outer, *this, _view);
        if (_shapes && !_followed)
            _hasher.addMatrix(_sceneFromLocal);
        else
            _hasher.add(node.getReferenceFrame());
        enter(node);
        _sceneFromLocal = outer;
    }

    void apply(osg::Billboard& node) override
    {
        hashView();
        _hasher.add(node.getMode(), node.getAxis(), node.getNormal());
        enter(node);
    }

    void apply(osg::ClipNode& node) override
    {
        addPlace();
        if (node.getReferenceFrame() == osg::ClipNode::ABSOLUTE_RF) hashView();
        for (const auto& plane : node.getClipPlaneList())
        {
            if (!plane) continue;
            _hasher.add(plane->getClipPlaneNum());
            if (_shapes) _hasher.add(plane->getClipPlane());
        }
        enter(node);
    }

    osg::CullStack* asCullStack() override { return _cullStack.at(_sceneFromLocal); }
    const osg::CullStack* asCullStack() const override { return _cullStack.at(_sceneFromLocal); }

    void apply(osg::Drawable& drawable) override
    {
        addDrawable(drawable);
        // The bound of other drawables has to do as the sign of a change.
        if (_shapes && drawable.getDataVariance() == osg::Object::DYNAMIC &&
            untracedDrawable(drawable))
            _hasher.add(DrawableTriangles::hashOf(drawable));
        traverse(drawable);
    }

    void apply(osg::Geometry& geometry) override
    {
        if (!_budget.take()) return;
        addDrawable(geometry);
        _hasher.add(geometry.getDrawCallback() != nullptr);
        if (!_shapes)
        {
            for (const auto& primitives : geometry.getPrimitiveSetList())
                _hasher.add(primitives && primitives->getNumInstances() > 1);
            return;
        }
        for (const float weight : SoftwareVertices::weightsOf(geometry))
            _hasher.add(weight);
        _arrays.clear();
        geometry.getArrayList(_arrays);
        for (const auto& array : _arrays)
            addArray(*array);
        for (const auto& primitives : geometry.getPrimitiveSetList())
            if (primitives) addPrimitives(*primitives);
        traverse(geometry);
    }

    float getDistanceToEyePoint(const osg::Vec3& point, bool useLodScale) const override
    {
        const float scale = useLodScale && _view ? _view->lodScale : 1.0f;
        // The inverse is taken as in a cull traversal.
        const osg::Vec3d eye = _eye * osg::Matrixd::inverse(_sceneFromLocal);
        return static_cast<float>((osg::Vec3d(point) - eye).length()) * scale;
    }

    float getDistanceToViewPoint(const osg::Vec3& point, bool useLodScale) const override
    {
        return getDistanceToEyePoint(point, useLodScale);
    }

private:
    /// Adds the view for nodes that turn to the view or move with it.
    void hashView()
    {
        if (!_shapes) return;
        _hasher.add(_eye);
        if (_view) _hasher.addMatrix(_view->viewFromWorld);
    }

    /// Adds the place of what nobody follows: transforms above those that are followed do not
    /// count.
    void addPlace()
    {
        if (_followed && _shapes) _hasher.addMatrix(_sceneFromLocal);
    }

    bool isFollowed(osg::Node& node) const
    {
        return _followed && _followed->count(&node) && !hasSpecialNodes(node);
    }

    void enter(osg::Node& node)
    {
        const bool shapes = _shapes, states = _states;
        const TraversalMode mode = getTraversalMode();
        if (isFollowed(node))
        {
            _shapes = _states = false;
            setTraversalMode(TRAVERSE_ALL_CHILDREN); // of a sequence, another is active each time
        }
        _hasher.addObject(&node);
        _hasher.addObject(node.getCullCallback());
        addOwnState(node);
        if (getNodePath().size() < kDeepestPath && _budget.take()) traverse(node);
        _shapes = shapes;
        _states = states;
        setTraversalMode(mode);
        _hasher.add(kEnd);
    }

    void addDrawable(const osg::Drawable& drawable)
    {
        _hasher.addObject(&drawable);
        addOwnState(drawable);
        _hasher.add(drawable.getCullingActive());
        if (!_shapes) return;
        addPlace();
        const osg::BoundingBox& box = drawable.getBoundingBox();
        _hasher.add(box._min, box._max);
    }

    void addArray(const osg::Array& array)
    {
        if (_versions) return _hasher.add(_versions->of(array));
        _hasher.addObject(&array);
        _hasher.add(array.getModifiedCount(), array.getNumElements(), array.getBinding());
    }

    void addPrimitives(const osg::PrimitiveSet& primitives)
    {
        if (_versions) return _hasher.add(_versions->of(primitives));
        _hasher.addObject(&primitives);
        _hasher.add(primitives.getModifiedCount(), primitives.getMode(),
                    hasTriangles(primitives) ? primitives.getNumIndices() : 0u,
                    rangesHash(primitives));
    }

    void addOwnState(const osg::Node& node)
    {
        _hasher.add(ownHint(node));
        if (_hasViewMasks) _hasher.add(node.getNodeMask());
        if (!_states) return;
        const osg::StateSet* stateSet = node.getStateSet();
        _hasher.addObject(stateSet);
        if (!stateSet) return;
        if (stateSet != _lastStateSet)
        {
            Hasher values(_kept);
            addStateSet(values, *stateSet, _reads.get());
            _lastStateSet = stateSet;
            _lastValues = values.value();
        }
        _hasher.add(_lastValues);
    }

    // Marks the end of the children, so that a node that moves one level up changes the hash.
    static constexpr int kEnd = -1;

    Hasher _hasher;
    KeptObjects* _kept;
    BufferVersions* _versions;
    PathBudget& _budget;
    osg::Vec3d _eye;
    std::optional<ReferenceView> _view;
    std::shared_ptr<const ShaderReads> _reads;
    bool _shapes = true; ///< false: arrays, bounds and transforms are left out
    bool _states = true;
    const std::unordered_set<const osg::Node*>* _followed = nullptr;
    bool _hasViewMasks; ///< whether node masks hide from some views alone
    ReferenceCullStack _cullStack;
    osg::Matrixd _sceneFromLocal;
    osg::Geometry::ArrayList _arrays;
    osg::ref_ptr<const osg::StateSet> _lastStateSet; ///< neighbours often share one
    uint64_t _lastValues = 0;                        ///< hash of its values
};

} // namespace

uint64_t graphHash(osg::Node& root, const ViewingConditions& conditions,
                   const osg::Matrixd& sceneFromLocal, KeptObjects* kept, BufferVersions* versions,
                   PathBudget* budget, const std::unordered_set<const osg::Node*>* followed)
{
    if (versions) versions->begin();
    PathBudget own;
    HashVisitor visitor(conditions, sceneFromLocal, kept, versions, budget ? *budget : own);
    visitor.follow(followed);
    root.accept(visitor);
    if (versions) versions->end();
    return visitor.value();
}

bool hasSpecialNodes(osg::Node& node)
{
    struct Finder : osg::NodeVisitor
    {
        Finder() : osg::NodeVisitor(NODE_VISITOR, TRAVERSE_ACTIVE_CHILDREN) {}
        void apply(osg::Node& visited) override
        {
            found = found || dynamic_cast<AreaLight*>(&visited) ||
                    dynamic_cast<EnvironmentLight*>(&visited) ||
                    dynamic_cast<MediumVolume*>(&visited) || isFrom(&visited, "osgVolume");
            if (!found) traverse(visited);
        }
        void apply(osg::LightSource&) override { found = true; }
        void apply(osg::ClipNode&) override { found = true; }
        void apply(osg::TexGenNode&) override { found = true; }
        void apply(osg::ClearNode&) override { found = true; }
        void apply(osg::Drawable&) override {}
        bool found = false;
    } finder;
    node.accept(finder);
    return finder.found;
}

uint64_t structureHash(osg::Node& root, const ViewingConditions& conditions, PathBudget& budget)
{
    HashVisitor visitor(conditions, osg::Matrixd(), nullptr, nullptr, budget);
    visitor.leaveShapesOut();
    root.accept(visitor);
    return visitor.value();
}

} // namespace osgRayTrace::engine
