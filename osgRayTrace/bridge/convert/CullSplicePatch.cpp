// CullSplicePatch.cpp - patches a scene for proxies of cull traversals that came or went. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/ClipPlanes.h"
#include "osgRayTrace/bridge/convert/Enclosures.h"
#include "osgRayTrace/bridge/convert/GraphLengths.h"
#include "osgRayTrace/bridge/convert/ScenePatcher.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"

#include <algorithm>

namespace osgRayTrace::engine
{

/// Takes out and puts in proxies, and nothing else. What OSG draws needs no patch: it culls the
/// whole subtree in each frame.
bool ScenePatcher::splice(const CullSplice& splice)
{
    if (!splice.removed.empty() || !splice.added.empty()) _spliced = _changed = true;
    for (const ChangedUse& gone : splice.removed)
        if (!removeProxy(gone)) return refuse(ConversionCause::CullTraversal, splice.path);
    if (!splice.added.empty() && !addProxies(splice)) return false;
    // A node that is shown again has told them before.
    std::vector<const osg::Geometry*> left;
    for (const osg::Geometry* geometry : splice.left)
        if (_convertedGraph.index.geometries.count(geometry) == 0) left.push_back(geometry);
    _convertedGraph.index.addUntraced({}, left);
    const uint32_t in = _convertedGraph.subtrees.find(splice.path);
    if (in == kNoSubtree) return true;
    ConvertedSubtree& subtree = _convertedGraph.subtrees.all[in];
    for (const auto& [reason, more] : splice.countsMore)
        subtree.counts[reason] += static_cast<uint64_t>(more);
    subtree.left.insert(subtree.left.end(), left.begin(), left.end());
    return true;
}

/// Returns false if the use is not the proxy that it should be.
bool ScenePatcher::removeProxy(const ChangedUse& gone)
{
    const auto found = _convertedGraph.index.geometries.find(gone.geometry);
    if (found == _convertedGraph.index.geometries.end()) return false;
    TracedGeometry& traced = found->second;
    if (!traced.culled || traced.uses.size() != 1 || traced.uses[0].effects != kInvalid)
        return false;
    for (const ClippedUse& use : _convertedGraph.clipped)
        if (use.geometry == gone.geometry) return false; // planes cut its mesh in its place
    const uint32_t index = traced.uses[0].instance;
    if (index != kInvalid)
    {
        const uint32_t mesh = _scene->instances[index].mesh;
        removeInstance(index);
        removeMesh(mesh);
        --_proxies;
    }
    if (const uint32_t in = traced.uses[0].subtree; in != kNoSubtree)
    {
        std::vector<ConvertedSubtree::Place>& places = _convertedGraph.subtrees.all[in].places;
        places.erase(std::remove_if(places.begin(), places.end(),
                                    [&gone](const ConvertedSubtree::Place& place)
                                    { return place.geometry == gone.geometry; }),
                     places.end());
    }
    _removed.push_back(traced.geometry);
    _convertedGraph.index.geometries.erase(found);
    return true;
}

bool ScenePatcher::addProxies(const CullSplice& splice)
{
    const auto refuseAll = [&](ConversionCause cause) { return refuse(cause, splice.path); };
    if (_input.assignsMaterials()) return refuseAll(ConversionCause::MaterialFile);
    ConversionReport report;
    GraphCollector collector(_input, _caches.vertices, _caches.triangles, _caches.textures,
                             _caches.rules, report);
    std::vector<CulledLeaf> leaves = splice.added;
    if (!collector.collectLeavesAt(splice.path, leaves))
        return refuseAll(ConversionCause::BadTransform);
    CollectedGraph graph = collector.take();
    if (graph.geometries.size() != leaves.size() || report.remarks() != leaves.size())
        return refuseAll(ConversionCause::CullTraversal);
    graph.texGens = _convertedGraph.texGens;
    if (!findBounds(graph)) return refuseAll(ConversionCause::LargeSubgraph);
    if (!lengthsOf(graph).areOrdinary()) return refuseAll(ConversionCause::Lengths);
    const uint32_t in = _convertedGraph.subtrees.find(splice.path);
    for (std::size_t i = 0; i < leaves.size(); ++i)
    {
        const CollectedGeometry& geometry = graph.geometries[i];
        const ConversionCause cause = geometry.geometry == leaves[i].drawable
                                          ? addProxy(graph, geometry, in)
                                          : ConversionCause::CullTraversal;
        if (cause != ConversionCause::None) return refuseAll(cause);
    }
    if (in != kNoSubtree)
        for (const ConvertedSubtree::Place& place : placesOf(graph))
            _convertedGraph.subtrees.all[in].places.push_back(place);
    if (_convertedGraph.inScene)
        _convertedGraph.inScene->insert(graph.inScene.begin(), graph.inScene.end());
    return true;
}

/// Returns None if the proxy was added, otherwise the cause against it.
ConversionCause ScenePatcher::addProxy(const CollectedGraph& graph,
                                       const CollectedGeometry& geometry, uint32_t subtree)
{
    if (geometry.uses.size() != 1 || !geometry.uses[0].proxy) return ConversionCause::CullTraversal;
    const GeometryUse& use = geometry.uses[0];
    if (clipPlanesOn(graph.states[use.state]) != 0) return ConversionCause::ClipPlanes;
    if (mayEnclose(*_scene, *geometry.bounds, use.engineFromLocal))
        return ConversionCause::CullTraversal;
    TracedGeometry& traced = _convertedGraph.index.at(*geometry.geometry);
    const bool isTraced =
        std::any_of(traced.uses.begin(), traced.uses.end(),
                    [](const TracedUse& other)
                    { return other.instance != kInvalid || other.effects != kInvalid; });
    if (isTraced) return ConversionCause::OtherPaths;
    _convertedGraph.index.removeUses(traced);
    ConversionReport report;
    SceneBuilder builder(_input, graph, patchRules(subtree), _caches, _convertedGraph, *_scene,
                         report);
    builder.add(geometry);
    const uint32_t index = traced.uses.front().instance;
    const uint64_t remarks = index == kInvalid ? 0 : 1; // it is counted as a proxy
    if (report.remarks() != remarks) return ConversionCause::Reported;
    if (index == kInvalid) return ConversionCause::None;
    if (!_scene->instances[index].placed) return ConversionCause::NotAnInstance;
    ++_instances;
    ++_proxies;
    return ConversionCause::None;
}

} // namespace osgRayTrace::engine
