// NodeEdits.cpp - which nodes came, went or have other state. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/bridge/changes/GraphWatch.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Each splice takes a walk over all watched nodes: more splices than this take longer than a
/// conversion.
constexpr std::size_t kMostSplices = 256;

/// Returns whether the graph must be converted if the node comes or goes; the nodes around such a
/// node are watched in another way, or it changes others.
bool isOfTheWhole(const WatchedNode& node)
{
    return node.kind == NodeKind::Untracked || node.kind == NodeKind::Clip || isLight(node.kind) ||
           node.hint != 0 || node.node->getCullCallback();
}

} // namespace

/// Finds out what differs in a node of a known class. Returns false if the look cannot go on.
bool GraphWatch::redo(uint32_t index, GraphChanges& changes)
{
    WatchedNode& node = _graph.nodes[index];
    if (node.kind == NodeKind::Untracked && node.hint == hintHash(*node.node))
        return redoUntracked(index, ConversionCause::Untracked, changes);
    if (node.hint != hintHash(*node.node)) return giveUp(changes, ConversionCause::Hint, index);
    if (_graph.isRepeated(*node.node)) return giveUp(changes, ConversionCause::SharedNode, index);
    const osg::StateSet* stateSet = node.node->getStateSet();
    const osg::StateSet* before =
        node.state == kNowhere ? nullptr : _graph.states[node.state].stateSet.get();
    bool known = false;
    if (stateSet != before)
    {
        _graph.setState(node.state, stateSet);
        node.stateChanged = node.stateDecides = _anyStateChanged = known = true;
    }
    const std::size_t splices = changes.splices.size();
    if (node.node->asGroup() && !redoChildren(index, changes)) return false;
    known |= changes.splices.size() > splices;
    WatchedNode& now = _graph.nodes[index];
    now.hash = nodeHash(now.kind, *now.node);
    return known || giveUp(changes, ConversionCause::ReferenceFrame, index);
}

/// Has the subtree of an untracked node collected again, and watches the node as it is now. Returns
/// false if there is more below it than is watched.
bool GraphWatch::redoUntracked(uint32_t index, ConversionCause cause, GraphChanges& changes)
{
    WatchedNode& node = _graph.nodes[index];
    UntrackedNode& untracked = _graph.untrackedNodes[node.item];
    PathBudget ofStructure(untracked.budget), budget(untracked.budget);
    untracked.structure = structureHash(*node.node, _plain, ofStructure);
    KeptObjects kept;
    node.hash = graphHash(*node.node, _plain, untracked.sceneFromLocal, &kept, nullptr, &budget);
    untracked.kept = std::move(kept);
    if (budget.left() == 0) return giveUp(changes, cause, index);
    changes.subtrees.push_back({cause, _graph.pathTo(index)});
    return true;
}

/// Compares the children of a node with its former ones, and takes out and puts in those that
/// differ. Returns false if the look cannot go on.
bool GraphWatch::redoChildren(uint32_t index, GraphChanges& changes)
{
    const NodeKind kind = _graph.nodes[index].kind;
    const osg::Group& group = *_graph.nodes[index].node->asGroup();
    const osg::NodeList& children = childrenOf(group);
    std::unordered_set<const osg::Node*> had, has;
    for (uint32_t i = index + 1; i < _graph.nodes[index].end; i = _graph.nodes[i].end)
        had.insert(_graph.nodes[i].node);
    for (unsigned int i = 0; i < children.size(); ++i)
        if (children[i] && isOn(kind, group, i)) has.insert(children[i].get());
    auto& hidden = _graph.hidden; // the node's hidden children are all found again
    hidden.erase(std::remove_if(hidden.begin(), hidden.end(),
                                [index](const HiddenNode& node) { return node.parent == index; }),
                 hidden.end());

    uint32_t at = index + 1;
    for (unsigned int i = 0; i < children.size(); ++i)
    {
        osg::Node* child = children[i].get();
        if (!child || !isOn(kind, group, i)) continue;
        const auto isThere = [&]
        { return at < _graph.nodes[index].end && _graph.nodes[at].node == child; };
        while (at < _graph.nodes[index].end && !isThere() && !has.count(_graph.nodes[at].node))
            if (!remove(at, changes)) return false;
        if (!isThere() && had.count(child))
            return giveUp(changes, ConversionCause::ChildOrder, index);
        if (!isThere() && !add(at, *child, index, changes)) return false;
        if (isThere()) at = _graph.nodes[at].end; // a hidden child is not there
    }
    while (at < _graph.nodes[index].end)
        if (!remove(at, changes)) return false;
    return true;
}

uint32_t GraphWatch::usesBefore(uint32_t geometry, uint32_t node) const
{
    uint32_t count = 0;
    if (_graph.geometries[geometry].uses == 1) return 0;
    for (uint32_t i = 0; i < node; ++i)
        count += _graph.nodes[i].kind == NodeKind::Geometry && _graph.nodes[i].item == geometry;
    return count;
}

bool GraphWatch::remove(uint32_t index, GraphChanges& changes)
{
    if (changes.splices.size() >= kMostSplices)
        return giveUp(changes, ConversionCause::ManyEdits, index);
    if (_graph.isRepeatedElsewhere(index))
        return giveUp(changes, ConversionCause::SharedNode, index);
    GraphSplice& splice = changes.splices.emplace_back();
    splice.removedFrom = _graph.pathTo(_graph.nodes[index].parent);
    for (uint32_t i = index; i < _graph.nodes[index].end; ++i)
    {
        const WatchedNode& node = _graph.nodes[i];
        if (isOfTheWhole(node)) mustRecord(changes, ConversionCause::SpecialNode, i);
        if (node.kind != NodeKind::Geometry) continue;
        const WatchedGeometry& watched = _graph.geometries[node.item];
        splice.removed.push_back({watched.geometry, usesBefore(node.item, i), watched.uses});
    }
    splice.gone = _graph.erase(index);
    return true;
}

bool GraphWatch::add(uint32_t at, osg::Node& node, uint32_t parent, GraphChanges& changes)
{
    if (changes.splices.size() >= kMostSplices)
        return giveUp(changes, ConversionCause::ManyEdits, parent);
    const std::size_t before = _graph.nodes.size();
    _graph.insert(at, node, parent, _plain);
    const auto count = static_cast<uint32_t>(_graph.nodes.size() - before);
    if (count == 0) return true;
    GraphSplice& splice = changes.splices.emplace_back();
    splice.added = _graph.pathTo(at);
    for (uint32_t i = at; i < at + count; ++i)
    {
        const WatchedNode& added = _graph.nodes[i];
        if (isOfTheWhole(added)) mustRecord(changes, ConversionCause::SpecialNode, i);
        if (added.kind != NodeKind::Geometry) continue;
        const WatchedGeometry& watched = _graph.geometries[added.item];
        splice.uses.push_back({watched.geometry, usesBefore(added.item, i), watched.uses});
    }
    return true;
}

/// Takes out a node that a mask has hidden. Returns false if the look cannot go on.
bool GraphWatch::hide(uint32_t index, GraphChanges& changes)
{
    HiddenNode gone{keep(_graph.nodes[index].node), _graph.nodes[index].parent};
    if (gone.parent == kNowhere) return giveUp(changes, ConversionCause::FirstNode, index);
    if (!remove(index, changes)) return false;
    _graph.hidden.push_back(std::move(gone));
    return true;
}

bool GraphWatch::lookAtHidden(GraphChanges& changes)
{
    std::size_t i = 0;
    while (i < _graph.hidden.size())
    {
        const HiddenNode& node = _graph.hidden[i++];
        if (!_graph.isVisible(*node.node)) continue;
        if (!redoChildren(node.parent, changes)) return false;
        i = 0; // the list holds other nodes now
    }
    return true;
}

} // namespace osgRayTrace::engine
