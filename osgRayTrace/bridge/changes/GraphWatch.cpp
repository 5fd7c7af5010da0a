// GraphWatch.cpp - compares the nodes of a graph with what they were. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/GraphWatch.h"

#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/bridge/changes/StateHash.h"
#include "osgRayTrace/bridge/common/NodePathText.h"
#include "osgRayTrace/bridge/common/SceneRoot.h"
#include "osgRayTrace/bridge/graph/UntracedParts.h"

#include <osg/NodeVisitor>

#include <algorithm>
#include <cstring>
#include <unordered_set>

namespace osgRayTrace::engine
{

namespace
{

/// So far ahead memory is fetched, by the offsets of what is read in it [OSG 3.6.5 on 64 bits]: for
/// others it is slower, but not wrong.
constexpr std::size_t kAhead = 16;
constexpr int kGroupBytes[] = {64, 200, 264, 328};
constexpr int kGeometryBytes[] = {64, 200, 332, 392, 440};
constexpr int kBufferBytes[] = {72, 136};

template <std::size_t N> inline void fetch(const void* object, const int (&bytes)[N])
{
    for (const int byte : bytes)
        __builtin_prefetch(static_cast<const char*>(object) + byte);
}

inline void fetch(const WatchedNode& node)
{
    if (node.kind == NodeKind::Geometry)
        fetch(node.node, kGeometryBytes);
    else
        fetch(node.node, kGroupBytes);
}

/// Each takes a walk over all that is watched: more than these take longer than a conversion.
constexpr std::size_t kMostSplices = 256;

/// What stands for the decorator has it below itself without being its parent.
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

/// Converts the graph where it comes or goes, and what is around it is watched in another way.
bool isOfTheWhole(const WatchedNode& node)
{
    return node.kind == NodeKind::Untracked || isLight(node.kind) || node.hint != 0;
}

uint64_t inheritedHash(const ViewingConditions& conditions, KeptObjects* kept = nullptr)
{
    Hasher hasher(kept);
    for (const osg::ref_ptr<const osg::StateSet>& stateSet : conditions.inheritedState)
        addStateSet(hasher, *stateSet);
    return hasher.value();
}

} // namespace

void GraphWatch::forget()
{
    *this = GraphWatch();
}

/// What stands for the decorator is looked through: it is no parent that would know of its end.
osg::Node* GraphWatch::firstNode(osg::Node& root) const
{
    if (!_graph.isVisible(root)) return nullptr;
    return typeid(root) == typeid(SceneRoot) ? soleNodeBelow(root, _graph.traversalMask) : &root;
}

void GraphWatch::record(osg::Node& root, const ViewingConditions& conditions)
{
    WatchedGraph before = std::move(_graph); // keeps its nodes alive until the end
    *this = GraphWatch();
    _graph.traversalMask = conditions.traversalMask;
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
    takeVersions(before);
    _graph.nodes.shrink_to_fit();
    _graph.kept.shrink_to_fit();
    _graph.places.shrink_to_fit();
    _recorded = true;
}

/// What is known of the contents of nodes that were there before.
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

GraphChanges GraphWatch::look(osg::Node& root, const ViewingConditions& conditions)
{
    GraphChanges changes;
    _root = &root;
    ConversionCause notComparable = ConversionCause::None;
    if (!_recorded)
        notComparable = ConversionCause::NotWatched;
    else if (conditions.traversalMask != _graph.traversalMask)
        notComparable = ConversionCause::OtherConditions;
    else if (ObjectName(firstNode(root)) != _first)
        notComparable = ConversionCause::FirstNode;
    _recorded = false; // until everything is seen
    _plain.eye = conditions.eye;
    _plain.view = conditions.view;
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
    const uint64_t inherited = inheritedHash(conditions);
    if (inherited != _inheritedHash)
    {
        mustConvert(changes, ConversionCause::InheritedState, kNowhere);
        KeptObjects kept;
        _inheritedHash = inheritedHash(conditions, &kept);
        _inheritedKept = std::move(kept);
    }
    if (_anyMoved || _anyStateChanged) findChanged(changes);
    // Nodes that the watch has not seen may be among those that came up.
    if (_graph.truncated && !changes.none())
        mustRecord(changes, ConversionCause::TooManyNodes, kNowhere);
    _recorded = true;
    return changes;
}

/// The graph is converted for what has changed at a node; kNowhere: at none of them. The first
/// reason stays.
void GraphWatch::mustConvert(GraphChanges& changes, ConversionCause cause, uint32_t node) const
{
    if (changes.reason.cause == ConversionCause::None)
        changes.reason = {cause, node == kNowhere ? std::string() : pathTo(node), nullptr, 0};
    changes.convert = true;
}

/// And what is watched is recorded again.
void GraphWatch::mustRecord(GraphChanges& changes, ConversionCause cause, uint32_t node) const
{
    mustConvert(changes, cause, node);
    changes.record = true;
}

/// False, for a look that cannot go on.
bool GraphWatch::giveUp(GraphChanges& changes, ConversionCause cause, uint32_t node) const
{
    mustRecord(changes, cause, node);
    return false;
}

/// From the root.
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

/// Matrices apart.
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

/// Where only modified counts differ the values of arrays decide.
bool GraphWatch::isUntrackedAsItWas(WatchedNode& node)
{
    UntrackedNode& untracked = _graph.untrackedNodes[node.item];
    PathBudget budget(untracked.budget), again(untracked.budget);
    const uint64_t hash =
        graphHash(*node.node, _plain, untracked.sceneFromLocal, nullptr, nullptr, &budget);
    if (hash == node.hash) return true;
    if (!untracked.versions) untracked.versions = std::make_unique<BufferVersions>();
    const uint64_t contents = graphHash(*node.node, _plain, untracked.sceneFromLocal, nullptr,
                                        untracked.versions.get(), &again);
    const bool same = untracked.contents == contents;
    untracked.contents = contents;
    if (same) node.hash = hash;
    return same;
}

/// False if the nodes that follow may be gone, and it cannot be said which.
bool GraphWatch::lookAtNodes(GraphChanges& changes)
{
    std::vector<WatchedNode>& nodes = _graph.nodes;
    uint32_t i = 0;
    while (i < nodes.size())
    {
        if (i + kAhead < nodes.size()) fetch(nodes[i + kAhead]);
        WatchedNode& node = nodes[i];
        if (!_graph.isVisible(*node.node))
        {
            if (!hide(i, changes)) return false;
            continue; // another one is here now
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

/// Finds out what differs in a node of a known class.
bool GraphWatch::redo(uint32_t index, GraphChanges& changes)
{
    WatchedNode& node = _graph.nodes[index];
    if (node.kind == NodeKind::Untracked) return giveUp(changes, ConversionCause::Untracked, index);
    if (node.hint != hintHash(*node.node)) return giveUp(changes, ConversionCause::Hint, index);
    if (_graph.isRepeated(*node.node)) return giveUp(changes, ConversionCause::SharedNode, index);
    const osg::StateSet* stateSet = node.node->getStateSet();
    const osg::StateSet* before =
        node.state == kNowhere ? nullptr : _graph.states[node.state].stateSet.get();
    bool known = false;
    if (stateSet != before)
    {
        _graph.setState(node.state, stateSet);
        node.stateChanged = _anyStateChanged = known = true;
    }
    const std::size_t splices = changes.splices.size();
    if (node.node->asGroup() && !redoChildren(index, changes)) return false;
    known |= changes.splices.size() > splices;
    WatchedNode& now = _graph.nodes[index];
    now.hash = nodeHash(now.kind, *now.node);
    return known || giveUp(changes, ConversionCause::ReferenceFrame, index);
}

/// Compares its children with those that it had, and takes out and puts in what differs.
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
    auto& hidden = _graph.hidden; // all of its own are found again
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
        if (isThere()) at = _graph.nodes[at].end; // not if it is hidden
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

/// A mask has hidden a node.
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
        i = 0; // they are others now
    }
    return true;
}

/// False if it is to be treated in another way.
bool GraphWatch::lookAtGeometry(uint32_t index, GraphChanges& changes)
{
    WatchedGeometry& watched = _graph.geometries[index];
    if (watched.looked == _looks) return true;
    watched.looked = _looks;
    const osg::Geometry& geometry = *watched.geometry;
    if (conversionHash(geometry) != watched.conversion) return false;
    const uint64_t arrays = arraysHash(geometry);
    if (geometry.getStateSet() == watched.stateSet && arrays == watched.arrays) return true;
    _graph.setState(watched.state, geometry.getStateSet());
    watched.stateSet = geometry.getStateSet();
    watched.stateChanged = _anyStateChanged = true;
    if (arrays == watched.arrays) return true;
    watched.arrays = arrays;
    _exchanged.push_back(index);
    changes.deformed.push_back(&geometry);
    return true;
}

void GraphWatch::lookAtBuffers(GraphChanges& changes)
{
    std::vector<WatchedBuffer>& buffers = _graph.buffers;
    const std::size_t count = buffers.size();
    for (std::size_t i = 0; i < count; ++i)
    {
        if (i + kAhead < count) fetch(buffers[i + kAhead].data.get(), kBufferBytes);
        WatchedBuffer& buffer = buffers[i];
        const uint64_t hash = bufferHash(buffer.kind, *buffer.data);
        if (hash == buffer.hash) continue;
        buffer.hash = hash;
        if (!buffer.contents.change(*buffer.data)) continue;
        const osg::Geometry* geometry = _graph.geometries[buffer.geometry].geometry;
        if (!buffer.shape && !changes.convert) // it may be a part of the material
        {
            changes.convert = true;
            changes.reason = {ConversionCause::VertexAttributes, pathOf(*geometry, 0), nullptr, 0};
        }
        if (buffer.shape && (changes.deformed.empty() || changes.deformed.back() != geometry))
            changes.deformed.push_back(geometry);
    }
}

void GraphWatch::lookAtStates()
{
    bool any = false;
    for (WatchedState& state : _graph.states)
    {
        state.changed = false;
        if (!state.stateSet) continue;
        Hasher hasher;
        addStateSet(hasher, *state.stateSet);
        state.changed = hasher.value() != state.hash;
        if (!state.changed) continue;
        any = true;
        KeptObjects kept;
        Hasher now(&kept);
        addStateSet(now, *state.stateSet);
        state.hash = now.value();
        state.kept = std::move(kept);
    }
    if (!any) return;
    _anyStateChanged = true;
    for (WatchedNode& node : _graph.nodes)
        if (node.state != kNowhere) node.stateChanged |= _graph.states[node.state].changed;
    for (WatchedGeometry& geometry : _graph.geometries)
        if (geometry.state != kNowhere)
            geometry.stateChanged |= _graph.states[geometry.state].changed;
}

void GraphWatch::lookAtLights(GraphChanges& changes)
{
    for (WatchedLight& light : _graph.lights)
    {
        const WatchedNode& node = _graph.nodes[light.node];
        if (lightHash(node.kind, *node.node) == light.hash) continue;
        changes.lights = true;
        KeptObjects kept;
        light.hash = lightHash(node.kind, *node.node, &kept);
        light.kept = std::move(kept);
    }
}

/// Follows what has changed down to the geometry below it.
void GraphWatch::findChanged(GraphChanges& changes)
{
    for (WatchedPlace& place : _graph.places) // the outer ones come first
    {
        if (place.node == kNowhere) continue;
        place.moved |= place.outer != kOutermost && _graph.places[place.outer].moved;
        if (place.moved && place.fixed)
            mustRecord(changes, ConversionCause::MovedSpecial, place.node);
    }
    std::unordered_map<uint32_t, osg::Matrixd> matrices; // few move
    const auto matrixOf = [&](uint32_t place) -> const osg::Matrixd&
    {
        const auto [known, isNew] = matrices.try_emplace(place);
        if (isNew) known->second = _graph.sceneFromLocal(place);
        return known->second;
    };
    for (WatchedGeometry& geometry : _graph.geometries)
        geometry.counted = 0;
    uint32_t stateChangedEnd = 0;
    for (uint32_t i = 0; i < _graph.nodes.size(); ++i)
    {
        WatchedNode& node = _graph.nodes[i];
        if (node.stateChanged) stateChangedEnd = std::max(stateChangedEnd, node.end);
        node.stateChanged = false;
        bool stateChanged = i < stateChangedEnd;
        if (stateChanged && node.kind == NodeKind::Untracked)
            mustConvert(changes, ConversionCause::UntrackedState, i);
        if (node.kind != NodeKind::Geometry) continue;
        WatchedGeometry& watched = _graph.geometries[node.item];
        stateChanged |= watched.stateChanged;
        const ChangedUse use{watched.geometry, watched.counted++, watched.uses};
        const bool moved = node.place != kNowhere && _graph.places[node.place].moved;
        if (changes.convert) continue;
        if (moved) changes.moved.push_back({use, matrixOf(node.place)});
        if (!stateChanged) continue;
        StateChange& other = changes.stateChanges.emplace_back();
        static_cast<ChangedUse&>(other) = use;
        other.worldFromLocal = matrixOf(node.place);
        other.path = _graph.pathTo(i);
    }
    for (WatchedPlace& place : _graph.places)
        place.moved = false;
    for (WatchedGeometry& geometry : _graph.geometries)
        geometry.stateChanged = false;
}

} // namespace osgRayTrace::engine
