// GraphWatch.cpp - compares the nodes of a graph with what they were. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/GraphWatch.h"

#include "osgRayTrace/base/MemoryHash.h"
#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/bridge/changes/Prefetch.h"
#include "osgRayTrace/bridge/changes/StateHash.h"
#include "osgRayTrace/bridge/common/NodePathText.h"
#include "osgRayTrace/bridge/common/SceneRoot.h"

#include <osg/NodeVisitor>

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the node that an active traversal meets directly below the given one. SceneRoot, which
/// stands for the decorator, has the decorator below itself without being its parent.
osg::Node* soleNodeBelow(osg::Node& node, unsigned int traversalMask)
{
    struct Finder : osg::NodeVisitor
    {
        Finder() : osg::NodeVisitor(NODE_VISITOR, TRAVERSE_ACTIVE_CHILDREN) {}
        void apply(osg::Node& visited) override
        {
            if (getNodePath().size() > 1)
                found = &visited;
            else
                traverse(visited);
        }
        osg::Node* found = nullptr;
    } finder;
    finder.setTraversalMask(traversalMask);
    node.accept(finder);
    return finder.found;
}

uint64_t inheritedHash(const ViewingConditions& conditions, KeptObjects* kept = nullptr)
{
    Hasher hasher(kept);
    for (const osg::ref_ptr<const osg::StateSet>& stateSet : conditions.inheritedState)
        addStateSet(hasher, *stateSet, conditions.reads.get());
    return hasher.value();
}

} // namespace

void GraphWatch::forget()
{
    *this = GraphWatch(_fetchesAhead);
}

/// Returns the first watched node, or null if nothing is visible. The watch looks through
/// SceneRoot, which stands for the decorator: SceneRoot is no parent that would know of the
/// decorator's end.
osg::Node* GraphWatch::firstNode(osg::Node& root) const
{
    if (!_graph.isVisible(root)) return nullptr;
    return typeid(root) == typeid(SceneRoot) ? soleNodeBelow(root, _graph.traversalMask) : &root;
}

void GraphWatch::record(osg::Node& root, const ViewingConditions& conditions)
{
    WatchedGraph before = std::move(_graph); // this copy keeps its nodes alive until the end
    *this = GraphWatch(_fetchesAhead);
    _graph.traversalMask = conditions.traversalMask;
    _graph.reads = conditions.reads;
    _plain = conditions;
    _plain.inheritedState.clear();
    _inheritedHash = inheritedHash(conditions, &_inheritedKept);
    _root = &root;
    osg::Node* const first = firstNode(root);
    _first = first;
    if (first)
    {
        _graph.owner = first == &root ? nullptr : first;
        _graph.firstDepth = first == &root ? 1 : 2;
        _graph.append(*first, kNowhere, osg::Matrixd(), _graph.firstDepth, _plain);
    }
    _graph.finish();
    _hidingHash = hidingHash();
    takeVersions(before);
    _graph.nodes.shrink_to_fit();
    _graph.kept.shrink_to_fit();
    _graph.places.shrink_to_fit();
    _recorded = true;
}

/// Returns a hash of the nodes that are hidden from some of the views, which OSG draws; 0 if the
/// views have the same mask.
uint64_t GraphWatch::hidingHash() const
{
    const std::vector<unsigned int>& masks = _plain.viewMasks;
    if (masks.empty()) return 0;
    uint64_t hash = 0;
    for (const WatchedNode& node : _graph.nodes)
    {
        const unsigned int own = node.node->getNodeMask();
        if (std::any_of(masks.begin(), masks.end(),
                        [own](unsigned int mask) { return (own & mask) == 0; }))
            hash += fold(bitsOf(node.node), 1);
    }
    return hash;
}

/// Takes over the known contents of the untracked nodes that were in the graph before.
void GraphWatch::takeVersions(WatchedGraph& before)
{
    std::unordered_map<const osg::Node*, UntrackedNode*> known;
    for (const WatchedNode& node : before.nodes)
        if (node.kind == NodeKind::Untracked && before.untrackedNodes[node.item].versions)
            known.emplace(node.node, &before.untrackedNodes[node.item]);
    if (known.empty()) return;
    for (const WatchedNode& node : _graph.nodes)
    {
        if (node.kind != NodeKind::Untracked) continue;
        const auto found = known.find(node.node);
        if (found == known.end()) continue;
        _graph.untrackedNodes[node.item].contents = found->second->contents;
        _graph.untrackedNodes[node.item].versions = std::move(found->second->versions);
        known.erase(found);
    }
}

GraphChanges GraphWatch::look(osg::Node& root, const ViewingConditions& conditions,
                              const ConvertedNodes* converted)
{
    GraphChanges changes;
    _root = &root;
    _converted = converted;
    ConversionCause notComparable = ConversionCause::None;
    if (!_recorded)
        notComparable = ConversionCause::NotWatched;
    else if (conditions.traversalMask != _graph.traversalMask ||
             conditions.viewMasks != _plain.viewMasks)
        notComparable = ConversionCause::OtherConditions;
    else if (ObjectName(firstNode(root)) != _first)
        notComparable = ConversionCause::FirstNode;
    _recorded = false; // this holds until everything is seen
    _plain.eye = conditions.eye;
    _plain.view = conditions.view;
    _plain.reads = _graph.reads = conditions.reads;
    _anyMoved = _anyStateChanged = false;
    _exchanged.clear();
    ++_looks;
    const bool comparable = notComparable == ConversionCause::None;
    changes.reason.cause = notComparable;
    if (!comparable || !lookAtNodes(changes) || !lookAtHidden(changes))
    {
        changes.convert = changes.record = true;
        return changes;
    }
    _graph.resetBuffers(_exchanged);
    lookAtBuffers(changes);
    lookAtStates();
    lookAtLights(changes);
    lookAtClips(changes);
    const uint64_t inherited = inheritedHash(conditions);
    if (inherited != _inheritedHash)
    {
        mustConvert(changes, ConversionCause::InheritedState, kNowhere);
        KeptObjects kept;
        _inheritedHash = inheritedHash(conditions, &kept);
        _inheritedKept = std::move(kept);
    }
    const uint64_t hiding = hidingHash();
    if (hiding != _hidingHash) mustConvert(changes, ConversionCause::NodeMask, kNowhere);
    _hidingHash = hiding;
    if (_anyMoved || _anyStateChanged) findChanged(changes);
    // Nodes that the watch has not seen may be among those that have moved up.
    if (_graph.truncated && !changes.none())
        mustRecord(changes, ConversionCause::TooManyNodes, kNowhere);
    _recorded = true;
    return changes;
}

/// Has the graph converted for a change at a node; kNowhere stands for a change at no single node.
/// The first reason stays.
void GraphWatch::mustConvert(GraphChanges& changes, ConversionCause cause, uint32_t node) const
{
    if (changes.reason.cause == ConversionCause::None)
        changes.reason = {cause, node == kNowhere ? std::string() : pathTo(node), nullptr, 0};
    changes.convert = true;
}

/// Has the graph converted, and has what is watched recorded again.
void GraphWatch::mustRecord(GraphChanges& changes, ConversionCause cause, uint32_t node) const
{
    mustConvert(changes, cause, node);
    changes.record = true;
}

/// Calls mustRecord() and returns false, for a look that cannot go on.
bool GraphWatch::giveUp(GraphChanges& changes, ConversionCause cause, uint32_t node) const
{
    mustRecord(changes, cause, node);
    return false;
}

/// Returns the text of the path from the root to a node.
std::string GraphWatch::pathTo(uint32_t node) const
{
    osg::NodePath path = _graph.pathTo(node);
    if (path.front() != _root) path.insert(path.begin(), _root);
    return pathText(path);
}

std::string GraphWatch::pathOf(const osg::Geometry& geometry, uint32_t use) const
{
    for (uint32_t i = 0; i < _graph.nodes.size(); ++i)
    {
        if (_graph.nodes[i].node != &geometry) continue;
        if (use == 0) return pathTo(i);
        --use;
    }
    return geometry.getName().empty() ? geometry.className() : geometry.getName();
}

/// Returns whether a node is unchanged apart from its matrix; a changed matrix marks the node's
/// place as moved.
bool GraphWatch::isAsItWas(WatchedNode& node)
{
    if (isTransform(node.kind))
    {
        WatchedPlace& place = _graph.places[node.place];
        const uint64_t hash = matrixHash(node.kind, *node.node);
        if (hash != place.hash)
        {
            place.hash = hash;
            place.moved = _anyMoved = true;
        }
    }
    if (node.kind == NodeKind::Untracked) return isUntrackedAsItWas(node);
    return node.repeated || nodeHash(node.kind, *node.node) == node.hash;
}

/// Returns whether somebody else follows what an untracked node shows: it is or lies below a
/// captured node, and has none of the nodes that cull traversals do not tell of.
bool GraphWatch::isFollowed(const WatchedNode& node) const
{
    if (!_converted || _converted->captured.empty()) return false;
    const std::unordered_set<const osg::Node*>& captured = _converted->captured;
    for (const WatchedNode* on = &node; !captured.count(on->node); on = &_graph.nodes[on->parent])
        if (on->parent == kNowhere) return false;
    return !hasSpecialNodes(*node.node);
}

/// Returns whether nothing of an untracked node is traced or lights what is: OSG draws all of it.
bool GraphWatch::isOutOfScene(const WatchedNode& node) const
{
    return _converted && _converted->inScene && !_converted->inScene->count(node.node);
}

/// Returns whether an untracked node is unchanged. If only modified counts differ, the values of
/// the arrays decide; others follow what is below captured nodes. Cull traversals do not tell of
/// masks that hide nodes from some of the views.
bool GraphWatch::isUntrackedAsItWas(WatchedNode& node)
{
    const bool isWithOthers = isFollowed(node);
    if (isWithOthers && _plain.viewMasks.empty() && node.hint == hintHash(*node.node)) return true;
    UntrackedNode& untracked = _graph.untrackedNodes[node.item];
    PathBudget budget(untracked.budget);
    const uint64_t hash =
        graphHash(*node.node, _plain, untracked.sceneFromLocal, nullptr, nullptr, &budget);
    if (hash == node.hash) return true;
    if (isWithOthers || isOutOfScene(node))
    {
        PathBudget same(untracked.budget);
        if (structureHash(*node.node, _plain, same) == untracked.structure)
        {
            node.hash = hash;
            return true;
        }
    }
    const bool same = isContentAsItWas(node);
    if (same) node.hash = hash;
    return same;
}

/// Returns whether the values of an untracked node are unchanged, and the places of what nobody
/// else follows.
bool GraphWatch::isContentAsItWas(WatchedNode& node)
{
    UntrackedNode& untracked = _graph.untrackedNodes[node.item];
    PathBudget budget(untracked.budget);
    if (!untracked.versions) untracked.versions = std::make_unique<BufferVersions>();
    const uint64_t contents =
        graphHash(*node.node, _plain, untracked.sceneFromLocal, nullptr, untracked.versions.get(),
                  &budget, _converted ? &_converted->captured : nullptr);
    const bool same = untracked.contents == contents;
    untracked.contents = contents;
    return same;
}

/// Returns whether nothing that is in the scene has moved with an untracked node, apart from what
/// others follow below it.
bool GraphWatch::movesWithOthers(WatchedNode& node)
{
    if (isFollowed(node) || isOutOfScene(node)) return true;
    if (!_converted || _converted->captured.empty() || !isContentAsItWas(node)) return false;
    UntrackedNode& untracked = _graph.untrackedNodes[node.item];
    PathBudget budget(untracked.budget);
    node.hash = graphHash(*node.node, _plain, untracked.sceneFromLocal, nullptr, nullptr, &budget);
    return true;
}

/// Returns false if the nodes that follow may be gone, and the watch cannot tell which.
bool GraphWatch::lookAtNodes(GraphChanges& changes)
{
    std::vector<WatchedNode>& nodes = _graph.nodes;
    uint32_t i = 0;
    while (i < nodes.size())
    {
        if (_fetchesAhead && i + kAhead < nodes.size()) fetch(nodes[i + kAhead]);
        WatchedNode& node = nodes[i];
        if (!_graph.isVisible(*node.node))
        {
            if (!hide(i, changes)) return false;
            continue; // another node is at this index now
        }
        if (node.kind == NodeKind::Geometry)
        {
            if (!lookAtGeometry(node.item, changes))
                return giveUp(changes, ConversionCause::DrawingMode, i);
        }
        else if (!isAsItWas(node) && !redo(i, changes))
            return false;
        ++i;
    }
    return true;
}

} // namespace osgRayTrace::engine
