// WatchedGraph.cpp - records graphs, and splices parts of them. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/WatchedGraph.h"

#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/bridge/changes/StateHash.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"

#include <osg/Transform>

#include <algorithm>
#include <iterator>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the index of a free place in a list with gaps.
template <class Item> uint32_t newIndex(std::vector<Item>& items, std::vector<uint32_t>& free)
{
    if (free.empty())
    {
        items.emplace_back();
        return static_cast<uint32_t>(items.size() - 1);
    }
    const uint32_t index = free.back();
    free.pop_back();
    items[index] = Item();
    return index;
}

/// Returns the place of a transform, which is within the place that the node has so far.
WatchedPlace placeOf(const WatchedNode& transform, uint32_t index)
{
    WatchedPlace here{};
    here.node = index;
    here.hash = matrixHash(transform.kind, *transform.node);
    here.outer = transform.place & kOutermost;
    return here;
}

} // namespace

/// Marks a place and all places around it as fixed, because their content depends on more than
/// matrices.
void WatchedGraph::fix(uint32_t place)
{
    for (; place != kNowhere && !places[place].fixed; place = outerPlace(place))
        places[place].fixed = true;
}

uint64_t WatchedGraph::decisionsHash(const osg::StateSet& stateSet) const
{
    Hasher hasher;
    addStateSet(hasher, stateSet, reads.get(), false);
    return hasher.value();
}

void WatchedGraph::setState(uint32_t& state, const osg::StateSet* stateSet)
{
    const uint32_t before = state;
    state = kNowhere;
    if (stateSet)
    {
        const auto [known, isNew] = _stateOf.try_emplace(stateSet, 0);
        if (isNew)
        {
            known->second = newIndex(states, _freeStates);
            WatchedState& fresh = states[known->second];
            fresh.stateSet = keep(stateSet);
            Hasher hasher(&fresh.kept);
            addStateSet(hasher, *stateSet, reads.get());
            fresh.hash = hasher.value();
            fresh.decisions = decisionsHash(*stateSet);
        }
        state = known->second;
        ++states[state].uses;
    }
    if (before == kNowhere || --states[before].uses > 0) return;
    _stateOf.erase(states[before].stateSet.get());
    states[before] = WatchedState();
    _freeStates.push_back(before);
}

void WatchedGraph::setBuffers(uint32_t index)
{
    forEachBuffer(
        *geometries[index].geometry, watchesAttributes(),
        [this, index](const osg::BufferData* data, bool shape)
        {
            if (!data) return;
            const BufferKind kind = bufferKindOf(*data);
            buffers.push_back({keep(data), bufferHash(kind, *data), index, kind, shape, {}});
        });
}

/// Sets the buffers of these geometries again; some of the geometries may be gone by now.
void WatchedGraph::resetBuffers(const std::vector<uint32_t>& exchanged)
{
    if (exchanged.empty()) return;
    std::vector<bool> isExchanged(geometries.size());
    for (const uint32_t index : exchanged)
        isExchanged[index] = geometries[index].geometry != nullptr;
    buffers.erase(std::remove_if(buffers.begin(), buffers.end(),
                                 [&](const WatchedBuffer& b) { return isExchanged[b.geometry]; }),
                  buffers.end());
    for (uint32_t index = 0; index < geometries.size(); ++index)
        if (isExchanged[index]) setBuffers(index);
}

void WatchedGraph::push(const WatchedNode& node)
{
    nodes.push_back(node);
    kept.push_back(keep(node.node == owner ? nullptr : node.node));
}

void WatchedGraph::append(osg::Node& node, uint32_t parent, const osg::Matrixd& sceneFromParent,
                          std::size_t depth, const ViewingConditions& conditions)
{
    if (!isVisible(node))
    {
        if (parent != kNowhere) hidden.push_back({keep(&node), parent});
        return;
    }
    if (depth > kDeepestPath) return;
    if (nodes.size() >= kMostWatched)
    {
        truncated = true;
        return;
    }
    WatchedNode entry;
    entry.node = &node;
    entry.kind = kindOf(node);
    entry.parent = parent;
    entry.place = parent == kNowhere ? kNowhere : nodes[parent].place;
    entry.hint = hintHash(node);
    const auto index = static_cast<uint32_t>(nodes.size());
    entry.end = index + 1;
    if (entry.kind == NodeKind::Geometry)
    {
        appendGeometry(static_cast<osg::Geometry&>(node), entry);
        return;
    }
    if (entry.kind == NodeKind::Untracked)
    {
        appendUntracked(entry, sceneFromParent, conditions);
        return;
    }

    entry.repeated = !_known.try_emplace(&node, true).second;
    repeats += entry.repeated;
    osg::Matrixd inner = sceneFromParent;
    if (isTransform(entry.kind))
    {
        places.push_back(placeOf(entry, index));
        entry.place = static_cast<uint32_t>(places.size() - 1);
        static_cast<osg::Transform&>(node).computeLocalToWorldMatrix(inner, nullptr);
    }
    if (isLight(entry.kind))
    {
        fix(entry.place);
        WatchedLight& light = lights.emplace_back();
        light.node = index;
        light.hash = lightHash(entry.kind, node, &light.kept);
    }
    entry.hash = nodeHash(entry.kind, node);
    setState(entry.state, node.getStateSet());
    push(entry);
    if (entry.kind == NodeKind::Clip)
        clips.push_back({index, clipHash(static_cast<const osg::ClipNode&>(node),
                                         sceneFromPlanes(index, conditions))});
    if (const osg::Group* group = node.asGroup())
        for (unsigned int i = 0; i < childrenOf(*group).size(); ++i)
            if (const osg::ref_ptr<osg::Node> child = childrenOf(*group)[i];
                child && isOn(entry.kind, *group, i))
                append(*child, index, inner, depth + 1, conditions);
    nodes[index].end = static_cast<uint32_t>(nodes.size());
}

void WatchedGraph::appendUntracked(WatchedNode entry, const osg::Matrixd& sceneFromParent,
                                   const ViewingConditions& conditions)
{
    entry.item = static_cast<uint32_t>(untrackedNodes.size());
    UntrackedNode& untracked = untrackedNodes.emplace_back();
    untracked.sceneFromLocal = sceneFromParent;
    untracked.budget = _untrackedBudget.left();
    PathBudget budget(untracked.budget);
    untracked.structure = structureHash(*entry.node, conditions, budget);
    entry.hash = graphHash(*entry.node, conditions, sceneFromParent, &untracked.kept, nullptr,
                           &_untrackedBudget);
    truncated |= _untrackedBudget.left() == 0;
    push(entry);
}

void WatchedGraph::appendGeometry(osg::Geometry& geometry, WatchedNode entry)
{
    const auto [known, isNew] = _geometryOf.try_emplace(&geometry, 0);
    if (isNew) known->second = newIndex(geometries, _freeGeometries);
    entry.item = known->second;
    WatchedGeometry& watched = geometries[entry.item];
    ++watched.uses;
    push(entry);
    if (!isNew) return;
    watched.geometry = &geometry;
    watched.arrays = arraysHash(geometry, watchesAttributes());
    watched.conversion = conversionHash(geometry);
    setState(watched.state, geometry.getStateSet());
    watched.stateSet = geometry.getStateSet();
    setBuffers(entry.item);
}

void WatchedGraph::finish()
{
    std::unordered_map<const osg::Node*, bool>().swap(_known); // frees the buckets as well
}

void WatchedGraph::insert(uint32_t at, osg::Node& node, uint32_t parent,
                          const ViewingConditions& conditions)
{
    const auto before = static_cast<uint32_t>(nodes.size());
    const std::size_t firstPlace = places.size(), firstLight = lights.size(),
                      firstClip = clips.size(), firstHidden = hidden.size();
    append(node, parent, sceneFromLocal(nodes[parent].place), pathTo(parent).size() + firstDepth,
           conditions);
    finish();
    const auto count = static_cast<uint32_t>(nodes.size()) - before;
    if (count == 0) return;
    for (uint32_t outer = parent; outer != kNowhere; outer = nodes[outer].parent)
        nodes[outer].end += count;
    if (at == before) return;

    // The appended nodes move back by this number; the nodes behind them move on by count.
    const uint32_t back = before - at;
    for (uint32_t i = at; i < before; ++i)
    {
        if (nodes[i].parent != kNowhere && nodes[i].parent >= at) nodes[i].parent += count;
        nodes[i].end += count;
    }
    for (uint32_t i = before; i < before + count; ++i)
    {
        if (nodes[i].parent >= before) nodes[i].parent -= back;
        nodes[i].end -= back;
    }
    const auto shift = [&](uint32_t& index, bool isNew)
    {
        if (index == kNowhere) return;
        if (index >= before)
            index -= back;
        else if (index >= at && !isNew)
            index += count;
    };
    for (std::size_t i = 0; i < places.size(); ++i)
        shift(places[i].node, i >= firstPlace);
    for (std::size_t i = 0; i < lights.size(); ++i)
        shift(lights[i].node, i >= firstLight);
    for (std::size_t i = 0; i < clips.size(); ++i)
        shift(clips[i].node, i >= firstClip);
    for (std::size_t i = 0; i < hidden.size(); ++i)
        shift(hidden[i].parent, i >= firstHidden);
    std::rotate(nodes.begin() + at, nodes.begin() + before, nodes.end());
    std::rotate(kept.begin() + at, kept.begin() + before, kept.end());
}

void WatchedGraph::releaseGeometry(uint32_t index)
{
    WatchedGeometry& watched = geometries[index];
    if (--watched.uses > 0) return;
    setState(watched.state, nullptr);
    _geometryOf.erase(watched.geometry);
    watched = WatchedGeometry();
    _freeGeometries.push_back(index);
}

std::vector<Kept<osg::Node>> WatchedGraph::erase(uint32_t at)
{
    const uint32_t end = nodes[at].end, count = end - at;
    const std::size_t freeGeometries = _freeGeometries.size();
    const auto isIn = [at, end](uint32_t index) { return index >= at && index < end; };
    for (uint32_t i = at; i < end; ++i)
    {
        WatchedNode& gone = nodes[i];
        if (gone.kind == NodeKind::Geometry) releaseGeometry(gone.item);
        setState(gone.state, nullptr);
        repeats -= gone.repeated;
        if (!isTransform(gone.kind)) continue;
        places[gone.place].node = kNowhere;
        ++_gonePlaces;
    }
    if (_freeGeometries.size() > freeGeometries)
        buffers.erase(std::remove_if(buffers.begin(), buffers.end(),
                                     [this](const WatchedBuffer& b)
                                     { return !geometries[b.geometry].geometry; }),
                      buffers.end());
    for (uint32_t outer = nodes[at].parent; outer != kNowhere; outer = nodes[outer].parent)
        nodes[outer].end -= count;
    lights.erase(std::remove_if(lights.begin(), lights.end(),
                                [&](const WatchedLight& light) { return isIn(light.node); }),
                 lights.end());
    clips.erase(std::remove_if(clips.begin(), clips.end(),
                               [&](const WatchedClip& clip) { return isIn(clip.node); }),
                clips.end());
    hidden.erase(std::remove_if(hidden.begin(), hidden.end(),
                                [&](const HiddenNode& node) { return isIn(node.parent); }),
                 hidden.end());
    const auto shift = [end, count](uint32_t& index)
    {
        if (index != kNowhere && index >= end) index -= count;
    };
    for (uint32_t i = end; i < nodes.size(); ++i)
    {
        shift(nodes[i].parent);
        nodes[i].end -= count;
    }
    for (WatchedPlace& place : places)
        shift(place.node);
    for (WatchedLight& light : lights)
        shift(light.node);
    for (WatchedClip& clip : clips)
        shift(clip.node);
    for (HiddenNode& node : hidden)
        shift(node.parent);
    nodes.erase(nodes.begin() + at, nodes.begin() + end);
    std::vector<Kept<osg::Node>> gone(std::make_move_iterator(kept.begin() + at),
                                      std::make_move_iterator(kept.begin() + end));
    kept.erase(kept.begin() + at, kept.begin() + end);
    if (2 * _gonePlaces > places.size()) dropGonePlaces();
    return gone;
}

void WatchedGraph::dropGonePlaces()
{
    std::vector<uint32_t> now(places.size(), kNowhere);
    uint32_t count = 0;
    for (uint32_t i = 0; i < places.size(); ++i)
    {
        if (places[i].node == kNowhere) continue;
        now[i] = count;
        places[count] = places[i];
        if (places[count].outer != kOutermost)
            places[count].outer = now[places[count].outer] & kOutermost;
        ++count;
    }
    places.resize(count);
    for (WatchedNode& node : nodes)
        if (node.place != kNowhere) node.place = now[node.place];
    _gonePlaces = 0;
}

bool WatchedGraph::isRepeated(const osg::Node& node) const
{
    return repeats > 0 &&
           std::count_if(nodes.begin(), nodes.end(),
                         [&node](const WatchedNode& n) { return n.node == &node; }) > 1;
}

bool WatchedGraph::isRepeatedElsewhere(uint32_t at) const
{
    if (repeats == 0) return false;
    const uint32_t end = nodes[at].end;
    std::unordered_map<const osg::Node*, bool> inside;
    for (uint32_t i = at; i < end; ++i)
        if (nodes[i].kind != NodeKind::Geometry) inside[nodes[i].node] = true;
    for (uint32_t i = 0; i < nodes.size(); ++i)
        if ((i < at || i >= end) && nodes[i].kind != NodeKind::Geometry &&
            inside.count(nodes[i].node))
            return true;
    return false;
}

osg::Matrixd WatchedGraph::sceneFromLocal(uint32_t place) const
{
    std::vector<const osg::Transform*> transforms;
    for (; place != kNowhere; place = outerPlace(place))
        transforms.push_back(static_cast<const osg::Transform*>(nodes[places[place].node].node));
    osg::Matrixd matrix;
    for (auto transform = transforms.rbegin(); transform != transforms.rend(); ++transform)
        (*transform)->computeLocalToWorldMatrix(matrix, nullptr);
    return matrix;
}

osg::Matrixd WatchedGraph::sceneFromPlanes(uint32_t node, const ViewingConditions& conditions) const
{
    const auto& clip = static_cast<const osg::ClipNode&>(*nodes[node].node);
    return clip.getReferenceFrame() == osg::ClipNode::ABSOLUTE_RF
               ? worldFromEye(conditions.view, conditions.eye)
               : sceneFromLocal(nodes[node].place);
}

osg::NodePath WatchedGraph::pathTo(uint32_t node) const
{
    osg::NodePath path;
    for (; node != kNowhere; node = nodes[node].parent)
        path.push_back(nodes[node].node);
    std::reverse(path.begin(), path.end());
    return path;
}

} // namespace osgRayTrace::engine
