// ValueEdits.cpp - which geometry, arrays, state and lights have other values. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/GraphWatch.h"
#include "osgRayTrace/bridge/changes/Prefetch.h"
#include "osgRayTrace/bridge/changes/StateHash.h"
#include "osgRayTrace/bridge/common/ClipPlanes.h"

#include <algorithm>
#include <unordered_map>

namespace osgRayTrace::engine
{

/// Looks at a geometry's state and arrays. Returns false if the geometry must be converted in
/// another way.
bool GraphWatch::lookAtGeometry(uint32_t index, GraphChanges& changes)
{
    WatchedGeometry& watched = _graph.geometries[index];
    if (watched.looked == _looks) return true;
    watched.looked = _looks;
    const osg::Geometry& geometry = *watched.geometry;
    if (conversionHash(geometry) != watched.conversion) return false;
    const uint64_t arrays = arraysHash(geometry, _graph.watchesAttributes());
    if (geometry.getStateSet() == watched.stateSet && arrays == watched.arrays) return true;
    _graph.setState(watched.state, geometry.getStateSet());
    watched.stateSet = geometry.getStateSet();
    watched.stateChanged = watched.stateDecides = _anyStateChanged = true;
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
        if (_fetchesAhead && i + kAhead < count)
            fetch(buffers[i + kAhead].data.get(), kBufferBytes);
        WatchedBuffer& buffer = buffers[i];
        const uint64_t hash = bufferHash(buffer.kind, *buffer.data);
        if (hash == buffer.hash) continue;
        buffer.hash = hash;
        if (!buffer.contents.change(*buffer.data)) continue;
        const osg::Geometry* geometry = _graph.geometries[buffer.geometry].geometry;
        const bool left = _converted && _converted->isLeft && _converted->isLeft(*geometry);
        if (!buffer.shape && !left && !changes.convert) // the buffer may be a part of the material
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
        state.changed = state.decides = false;
        if (!state.stateSet) continue;
        Hasher hasher;
        addStateSet(hasher, *state.stateSet, _graph.reads.get());
        state.changed = hasher.value() != state.hash;
        if (!state.changed) continue;
        any = true;
        const uint64_t decisions = _graph.decisionsHash(*state.stateSet);
        state.decides = decisions != state.decisions;
        state.decisions = decisions;
        KeptObjects kept;
        Hasher now(&kept);
        addStateSet(now, *state.stateSet, _graph.reads.get());
        state.hash = now.value();
        state.kept = std::move(kept);
    }
    if (!any) return;
    _anyStateChanged = true;
    for (WatchedNode& node : _graph.nodes)
        if (node.state != kNowhere)
        {
            node.stateChanged |= _graph.states[node.state].changed;
            node.stateDecides |= _graph.states[node.state].decides;
        }
    for (WatchedGeometry& geometry : _graph.geometries)
        if (geometry.state != kNowhere)
        {
            geometry.stateChanged |= _graph.states[geometry.state].changed;
            geometry.stateDecides |= _graph.states[geometry.state].decides;
        }
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

/// Planes that cut nothing in the scene may be anywhere.
void GraphWatch::lookAtClips(GraphChanges& changes)
{
    const uint64_t cutting = _converted ? _converted->cuttingPlanes : ~uint64_t(0);
    bool changed = false;
    for (WatchedClip& clip : _graph.clips)
    {
        const auto& node = static_cast<const osg::ClipNode&>(*_graph.nodes[clip.node].node);
        const uint64_t hash = clipHash(node, _graph.sceneFromPlanes(clip.node, _plain));
        if (hash == clip.hash) continue;
        clip.hash = hash;
        changed |= (planeNumbers(node) & cutting) != 0;
    }
    if (!changed) return;
    for (const WatchedClip& clip : _graph.clips)
        changes.clips.push_back({static_cast<const osg::ClipNode*>(_graph.nodes[clip.node].node),
                                 _graph.sceneFromPlanes(clip.node, _plain)});
}

/// Follows changed places and states down to the geometries below them.
void GraphWatch::findChanged(GraphChanges& changes)
{
    for (WatchedPlace& place : _graph.places) // outer places come first
    {
        if (place.node == kNowhere) continue;
        place.moved |= place.outer != kOutermost && _graph.places[place.outer].moved;
        if (place.moved && place.fixed)
            mustRecord(changes, ConversionCause::MovedSpecial, place.node);
    }
    std::unordered_map<uint32_t, osg::Matrixd> matrices; // the map is small, since few places move
    const auto matrixOf = [&](uint32_t place) -> const osg::Matrixd&
    {
        const auto [known, isNew] = matrices.try_emplace(place);
        if (isNew) known->second = _graph.sceneFromLocal(place);
        return known->second;
    };
    for (WatchedGeometry& geometry : _graph.geometries)
        geometry.counted = 0;
    uint32_t stateChangedEnd = 0, stateDecidesEnd = 0;
    for (uint32_t i = 0; i < _graph.nodes.size(); ++i)
    {
        WatchedNode& node = _graph.nodes[i];
        if (node.stateChanged) stateChangedEnd = std::max(stateChangedEnd, node.end);
        if (node.stateDecides) stateDecidesEnd = std::max(stateDecidesEnd, node.end);
        node.stateChanged = node.stateDecides = false;
        bool stateChanged = i < stateChangedEnd;
        const bool decides = i < stateDecidesEnd;
        if (stateChanged && node.kind == NodeKind::Untracked && (decides || !isOutOfScene(node)))
            changes.subtrees.push_back({ConversionCause::UntrackedState, _graph.pathTo(i)});
        const bool moved = node.place != kNowhere && _graph.places[node.place].moved;
        if (moved && node.kind == NodeKind::Untracked)
        {
            _graph.untrackedNodes[node.item].sceneFromLocal = matrixOf(node.place);
            if (!movesWithOthers(node) && !redoUntracked(i, ConversionCause::MovedSpecial, changes))
                return;
        }
        if (node.kind != NodeKind::Geometry) continue;
        WatchedGeometry& watched = _graph.geometries[node.item];
        stateChanged |= watched.stateChanged;
        const ChangedUse use{watched.geometry, watched.counted++, watched.uses};
        if (changes.convert) continue;
        if (moved) changes.moved.push_back({use, matrixOf(node.place)});
        if (!stateChanged) continue;
        StateChange& other = changes.stateChanges.emplace_back();
        static_cast<ChangedUse&>(other) = use;
        other.worldFromLocal = matrixOf(node.place);
        other.path = _graph.pathTo(i);
        other.looksOnly = !decides && !watched.stateDecides;
    }
    for (WatchedPlace& place : _graph.places)
        place.moved = false;
    for (WatchedGeometry& geometry : _graph.geometries)
        geometry.stateChanged = geometry.stateDecides = false;
}

} // namespace osgRayTrace::engine
