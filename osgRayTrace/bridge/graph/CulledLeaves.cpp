// CulledLeaves.cpp - collects the leaves of cull traversals, as traced ones and as proxies. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/DrawHint.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"

#include <osg/Transform>

namespace osgRayTrace::engine
{

/// Traverses what is below a node, with the node's state and transform.
void GraphCollector::walkBelow(osg::Node& node)
{
    const bool pushed = pushState(node);
    if (const osg::Transform* transform = node.asTransform())
        traverseBelow(worldBelow(*transform), node);
    else
        traverseChildren(node);
    if (pushed) _states.pop();
}

/// Returns true if the node was collected with all below it: OSG draws all of it by a hint, or its
/// own cull traversal has told what it shows.
bool GraphCollector::collectsInCull(osg::Node& node)
{
    if (_lightsOnly || _isLeft || _leftToOsg > 0 || &node == _input.root) return false;
    const bool someSee = isForSomeViews(node) && (node.asGroup() || cullReason(node));
    if (someSee || (_input.rasterizesRest && node.getUserDataContainer() && node.asGroup() &&
                    leavesToOsg(hintOf(getNodePath())) && isHintedAlike(node)))
    {
        rasterize();
        if (!node.asGroup())
        {
            _report.count("rasterized.view-mask");
            return true;
        }
        _isLeft = true;
        walkBelow(node);
        _isLeft = false;
        return true;
    }
    const char* reason = cullReason(node);
    if (!reason || hintOf(getNodePath()) == DrawHint::Trace) return false;
    if (!_input.pass || !_input.view)
    {
        _report.count("approximated.cull-traversal");
        _graph.cullUnknown = true;
        return false;
    }
    // A cull traversal of so many paths would not end, with this library or without.
    if (_counts.of(node, kMostPaths, kDeepestPath) > kMostPaths) return false;
    HookAnswers answers;
    _materials.keepAnswers(&answers);
    CullOutcome outcome = cullOutcome();
    const bool collected = outcome.kind != CullOutcome::Plain;
    if (collected) collectCulled(node, outcome, reason);
    _materials.keepAnswers(nullptr);
    outcome.answers = std::move(answers);
    _graph.cullOutcomes.push_back(std::move(outcome));
    return collected;
}

/// Returns true if a drawable of the application's was collected by what it chooses in cull.
bool GraphCollector::collectsChosen(osg::Drawable& drawable)
{
    if (!_input.rasterizesRest || !_input.pass || !_input.view || _isLeft || _leftToOsg > 0 ||
        leavesToOsg(hintOf(getNodePath())) || isForSomeViews(drawable))
        return false;
    const char* reason = cullReason(drawable);
    if (!reason) return false;
    HookAnswers answers;
    _materials.keepAnswers(&answers);
    CullOutcome outcome = cullOutcome();
    const bool collected = outcome.kind == CullOutcome::Captured;
    if (collected) collectCulled(drawable, outcome, reason);
    _materials.keepAnswers(nullptr);
    outcome.answers = std::move(answers);
    if (outcome.kind != CullOutcome::Left) _graph.cullOutcomes.push_back(std::move(outcome));
    return collected;
}

/// Collects a node by the leaves of its cull traversal.
void GraphCollector::collectCulled(osg::Node& node, CullOutcome& outcome, const char* reason)
{
    const bool outermost = _captured == 0;
    if (outermost) _captured = getNodePath().size();
    if (!outcome.record.error().empty())
        _report.warn("warned.cull-exception", "node '" + path() + "'",
                     "has thrown an exception in a cull traversal, left to OSG: " +
                         outcome.record.error());
    _lightsOnly = true;
    walkBelow(node);
    _lightsOnly = false;
    if (outcome.isDrawn())
    {
        _report.count(reason);
        rasterize();
        if (_graph.rasterized.size() > 0) _graph.rasterized.back().traced = tracedLeaves(outcome);
    }
    else
        rasterize(RasterizedPart::Pick);
    ++_untracked;
    for (CulledLeaf& leaf : outcome.leaves)
        collectLeaf(leaf);
    --_untracked;
    if (outermost) _captured = 0;
}

bool GraphCollector::collectLeavesAt(const osg::NodePath& path, std::vector<CulledLeaf>& leaves)
{
    if (!descendTo(path)) return false;
    pushOntoNodePath(path.back());
    ++_untracked;
    for (CulledLeaf& leaf : leaves)
        collectLeaf(leaf);
    --_untracked;
    return true;
}

void GraphCollector::collectLeaf(CulledLeaf& leaf)
{
    osg::Geometry* geometry = leaf.drawable->asGeometry();
    pushOntoNodePath(leaf.drawable.get());
    if (leaf.left)
    {
        _report.count(leaf.left);
        if (geometry && !leaf.made) leave(*geometry);
    }
    if (leaf.isInScene() && pushMatrix(leaf.worldFromLocal))
    {
        const std::size_t pushed = pushStates(leaf);
        leaf.number = _culledLeaf = _culledLeaves++;
        if (leaf.left)
            collectProxy(*leaf.drawable);
        else
        {
            _report.count("converted.culled");
            apply(*geometry);
        }
        _culledLeaf = kNoCulledLeaf;
        popStates(pushed);
        _worldFromLocal.pop_back();
    }
    popFromNodePath();
}

/// Collects the triangles of a drawable that OSG draws.
void GraphCollector::collectProxy(osg::Drawable& drawable)
{
    osg::Geometry* geometry = drawable.asGeometry();
    const osg::Geometry* triangles =
        geometry ? &_vertices.posed(*geometry, getNodePath()) : _triangles.of(drawable);
    if (triangles) collectUse(*triangles, assignedState(drawable).state, true);
}

/// Returns the leaves that OSG does not draw, although it culls the whole subtree.
osg::ref_ptr<TracedLeaves> GraphCollector::tracedLeaves(const CullOutcome& outcome)
{
    osg::ref_ptr<TracedLeaves> traced;
    for (const CulledLeaf& leaf : outcome.leaves)
    {
        if (leaf.left) continue;
        if (!traced) traced = new TracedLeaves;
        if (leaf.made)
            traced->made = true;
        else if (traced->drawables.insert(leaf.drawable.get()).second)
            traced->kept.push_back(leaf.drawable);
    }
    return traced;
}

} // namespace osgRayTrace::engine
