// SubtreePatch.cpp - patches a scene for what has changed in unwatched subtrees. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/Enclosures.h"
#include "osgRayTrace/bridge/convert/GraphLengths.h"
#include "osgRayTrace/bridge/convert/ScenePatcher.h"
#include "osgRayTrace/bridge/convert/SubtreeComparison.h"
#include "osgRayTrace/bridge/graph/DrawHint.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"

#include <algorithm>
#include <iterator>
#include <unordered_set>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Returns whether OSG may draw all of what is below one of the nodes above the last one: by a
/// hint, or since the node's mask hides it from some of the views.
bool isLeftAbove(const osg::NodePath& path, const std::vector<unsigned int>& viewMasks)
{
    const auto mayBeLeft = [&viewMasks](const osg::Node* node)
    {
        return ownHint(*node) != DrawHint::None ||
               std::any_of(viewMasks.begin(), viewMasks.end(),
                           [node](unsigned int mask) { return (node->getNodeMask() & mask) == 0; });
    };
    return std::any_of(path.begin(), path.end() - 1, mayBeLeft);
}

/// Drops what is known to have no proxy, as it would enclose the scene, and records where it is:
/// see ScenePatcher::encloseStill().
void dropKnownEnclosures(CollectedGraph& graph, ConvertedSubtrees& subtrees)
{
    const auto encloses = [&subtrees](const CollectedGeometry& geometry)
    {
        if (!geometry.isProxy() || geometry.uses.size() != 1) return false;
        Enclosure* enclosure = subtrees.enclosure(*geometry.geometry);
        if (!enclosure) return false;
        enclosure->engineFromLocal = geometry.uses[0].engineFromLocal;
        enclosure->bounds = *geometry.bounds;
        enclosure->moved = true;
        return enclosure->encloses;
    };
    graph.geometries.erase(
        std::remove_if(graph.geometries.begin(), graph.geometries.end(), encloses),
        graph.geometries.end());
}

/// Returns the part of the scene that each leaf of a cull traversal has become.
CullWatch::LeafUses leafUsesOf(const CollectedGraph& graph, const SceneIndex& index,
                               uint32_t subtree)
{
    CullWatch::LeafUses leaves;
    for (const CollectedGeometry& geometry : graph.geometries)
    {
        const auto found = index.geometries.find(geometry.geometry);
        if (found == index.geometries.end()) continue;
        const std::vector<uint32_t> uses = usesIn(found->second, subtree);
        const auto count = static_cast<uint32_t>(found->second.uses.size());
        for (std::size_t i = 0; i < geometry.uses.size() && i < uses.size(); ++i)
            if (geometry.uses[i].culled != kNoCulledLeaf)
                leaves[geometry.uses[i].culled] = {geometry.geometry.get(), uses[i], count};
    }
    return leaves;
}

} // namespace

/// Collects a subtree again, and exchanges what is in the scene otherwise than it would be made
/// now.
bool ScenePatcher::redo(const ChangedSubtree& changed)
{
    const osg::NodePath path = fromRoot(changed.path);
    const auto refuseAll = [&](ConversionCause cause) { return refuse(cause, path); };
    const uint32_t subtree = _convertedGraph.subtrees.find(path);
    if (subtree == kNoSubtree || isLeftAbove(path, _input.viewMasks))
        return refuseAll(changed.cause);
    if (_input.assignsMaterials()) return refuseAll(ConversionCause::MaterialFile);
    if (!_redone.insert(subtree).second) return true;
    if (_convertedGraph.subtrees.all[subtree].special) return refuseAll(changed.cause);
    ConversionReport report;
    GraphCollector collector(_input, _caches.vertices, _caches.triangles, _caches.textures,
                             _caches.rules, report);
    if (!collector.collectAt(_convertedGraph.subtrees.all[subtree].path))
        return refuseAll(ConversionCause::BadTransform);
    CollectedGraph graph = collector.take();
    const bool plain = graph.subtrees.size() == 1 && !graph.subtrees.front().special &&
                       !graph.cullUnknown && graph.lights.volumes.empty();
    if (!plain) return refuseAll(changed.cause);
    graph.texGens = _convertedGraph.texGens;
    uint64_t more = 0;
    for (CollectedGeometry& geometry : graph.geometries)
    {
        geometry.bounds = &_caches.geometries.bounds(*geometry.geometry);
        if (geometry.bounds->count < kPlacedVertices &&
            !_convertedGraph.index.geometries.count(geometry.geometry))
            more += geometry.bounds->count;
    }
    if (more > kSmallStatic && more >= _caches.staticVertices)
        return refuseAll(ConversionCause::LargeSubgraph);
    if (!graph.geometries.empty() && !lengthsOf(graph).areOrdinary())
        return refuseAll(ConversionCause::Lengths);
    dropKnownEnclosures(graph, _convertedGraph.subtrees);
    const ConversionCause cause = exchange(subtree, graph);
    if (cause != ConversionCause::None) return refuseAll(cause);
    record(subtree, graph, report.counts());
    return true;
}

/// Exchanges the geometries of a subtree that differ. Returns None, otherwise the cause against it.
ConversionCause ScenePatcher::exchange(uint32_t subtree, const CollectedGraph& graph)
{
    SubtreeComparison comparison(_input, graph, *_scene, _caches, _convertedGraph, subtree);
    std::vector<const CollectedGeometry*> others;
    std::unordered_set<const osg::Geometry*> stays;
    for (const CollectedGeometry& geometry : graph.geometries)
    {
        // A geometry with two primitive restarts has two meshes, and one entry in the index.
        if (!stays.insert(geometry.geometry).second) return ConversionCause::NotAlone;
        if (!comparison.isSame(geometry)) others.push_back(&geometry);
    }
    _newMaterials = std::move(comparison.materials());
    takeNewMaterials();
    std::unordered_set<const osg::Geometry*> goes;
    for (const ConvertedSubtree::Place& place : _convertedGraph.subtrees.all[subtree].places)
        if (!stays.count(place.geometry)) goes.insert(place.geometry);
    for (const CollectedGeometry* geometry : others)
        goes.insert(geometry->geometry);
    for (const osg::Geometry* geometry : goes)
    {
        const ConversionCause cause = removeUses(*geometry, subtree);
        if (cause != ConversionCause::None) return cause;
    }
    for (const CollectedGeometry* geometry : others)
    {
        const ConversionCause cause = addUses(graph, *geometry, subtree);
        if (cause != ConversionCause::None) return cause;
    }
    return ConversionCause::None;
}

/// Takes the uses that a geometry has in a subtree out of the scene. Returns None, otherwise the
/// cause against it.
ConversionCause ScenePatcher::removeUses(const osg::Geometry& geometry, uint32_t subtree)
{
    const auto found = _convertedGraph.index.geometries.find(&geometry);
    if (found == _convertedGraph.index.geometries.end()) return ConversionCause::None;
    TracedGeometry& traced = found->second;
    const std::vector<uint32_t> uses = usesIn(traced, subtree);
    if (uses.empty()) return ConversionCause::None;
    for (const ClippedUse& use : _convertedGraph.clipped)
        if (use.geometry == &geometry) return ConversionCause::ClipPlanes;
    const bool all = uses.size() == traced.uses.size();
    if (!all && traced.raised) return ConversionCause::OtherPaths;
    if (!all && traced.remarks) return ConversionCause::Reported;
    const bool counted = std::any_of(traced.uses.begin(), traced.uses.end(),
                                     [](const TracedUse& use) { return use.effects != kInvalid; });
    std::set<uint32_t> meshes;
    for (auto use = uses.rbegin(); use != uses.rend(); ++use)
    {
        const TracedUse gone = traced.uses[*use];
        _convertedGraph.index.removeUse(traced, *use);
        if (gone.instance == kInvalid) continue;
        if (!all && !_scene->instances[gone.instance].placed) return ConversionCause::NotAnInstance;
        if (gone.effects != kInvalid)
        {
            const StateEffects& effects = _convertedGraph.index.stateEffects[gone.effects];
            if (effects.hasAmbient || effects.physical || effects.setsColor)
                _goneEffects.insert(gone.effects);
        }
        meshes.insert(_scene->instances[gone.instance].mesh);
        removeInstance(gone.instance);
        _spliced = _changed = true;
    }
    if (!all)
    {
        // All uses must share one mesh, which stays for those that are left.
        for (const TracedUse& use : traced.uses)
            if (use.instance == kInvalid || meshes.count(_scene->instances[use.instance].mesh) == 0)
                return ConversionCause::NotAnInstance;
        if (traced.culled)
            _convertedGraph.cullWatch.renumber(geometry, uses,
                                               static_cast<uint32_t>(traced.uses.size()));
        return meshes.size() > 1 ? ConversionCause::NotAnInstance : ConversionCause::None;
    }
    for (const uint32_t mesh : meshes)
        removeMesh(mesh);
    if (counted) _geometries -= static_cast<int64_t>(meshes.size());
    if (traced.remarks)
        for (const auto& [what, number] : *traced.remarks)
            _countsMore[what] -= static_cast<int64_t>(number);
    _removed.push_back(traced.geometry);
    _convertedGraph.index.geometries.erase(found);
    return ConversionCause::None;
}

/// Puts the uses of a geometry of a subtree into the scene. Returns None, otherwise the cause
/// against it.
ConversionCause ScenePatcher::addUses(const CollectedGraph& graph,
                                      const CollectedGeometry& geometry, uint32_t subtree)
{
    const ConversionCause byState = stateCause(graph, geometry);
    if (byState != ConversionCause::None) return byState;
    for (const GeometryUse& use : geometry.uses)
        if (use.proxy && mayEnclose(*_scene, *geometry.bounds, use.engineFromLocal))
            return ConversionCause::CullTraversal;
    ConversionReport report;
    SceneBuilder builder(_input, graph, patchRules(subtree), _caches, _convertedGraph, *_scene,
                         report);
    const auto known = _convertedGraph.index.geometries.find(geometry.geometry);
    const bool isElsewhere = known != _convertedGraph.index.geometries.end() &&
                             !_convertedGraph.index.isLeft(*geometry.geometry);
    _spliced = _changed = true;
    if (isElsewhere)
    {
        const TracedGeometry& traced = known->second;
        const MeshRequest* request = _caches.geometries.lastRequest(*geometry.geometry);
        if (traced.culled != geometry.isCulled() || geometry.isProxy() || !request ||
            !(request->restart == geometry.restart) ||
            request->pointRadius != geometry.pointRadius ||
            !_caches.geometries.isCurrent(*geometry.geometry))
            return ConversionCause::OtherPaths;
        for (const GeometryUse& use : geometry.uses)
            if (use.proxy ||
                !builder.addUse(geometry, use, static_cast<uint32_t>(traced.uses.size())))
                return ConversionCause::NotAnInstance;
        if (report.remarks() > 0) return ConversionCause::Reported;
        if (traced.culled)
            _convertedGraph.cullWatch.renumber(*geometry.geometry, {},
                                               static_cast<uint32_t>(traced.uses.size()));
        else
            known->second.patchable &= geometry.watched;
    }
    else
        builder.add(geometry);
    const auto isThere = [this](const TracedUse& use)
    { return use.instance == kInvalid || _scene->instances[use.instance].placed; };
    const TracedGeometry& traced = _convertedGraph.index.at(*geometry.geometry);
    if (!std::all_of(traced.uses.begin(), traced.uses.end(), isThere))
        return ConversionCause::NotAnInstance;
    for (const auto& [what, number] : report.counts())
        _countsMore[what] += static_cast<int64_t>(number);
    return ConversionCause::None;
}

/// Keeps what a subtree is now.
void ScenePatcher::record(uint32_t index, CollectedGraph& graph, const ConversionCounts& counts)
{
    ConvertedSubtree& subtree = _convertedGraph.subtrees.all[index];
    for (const auto& [what, number] : counts)
        _countsMore[what] += static_cast<int64_t>(number);
    for (const auto& [what, number] : subtree.counts)
        _countsMore[what] -= static_cast<int64_t>(number);
    subtree.counts = graph.subtrees.front().counts;

    const auto forget = [this](const osg::Geometry* geometry)
    {
        if (geometry && _convertedGraph.index.isLeft(*geometry))
            _convertedGraph.index.geometries.erase(geometry);
    };
    const RasterizedParts& parts = *_convertedGraph.subtrees.parts;
    const std::vector<uint32_t>& owners = _convertedGraph.subtrees.partSubtrees;
    bool drawn = !graph.rasterized.empty();
    for (std::size_t i = subtree.parts; i < parts.size() && owners[i] == index; ++i)
    {
        drawn = true;
        if (!parts[i].path.empty()) forget(parts[i].path.back()->asGeometry());
    }
    for (const osg::Geometry* geometry : subtree.left)
        forget(geometry);
    _convertedGraph.index.addUntraced(graph.rasterized, graph.leftGeometries);
    subtree.left = std::move(graph.leftGeometries);
    subtree.places = placesOf(graph);
    _convertedGraph.cullWatch.replace(subtree.path, graph,
                                      leafUsesOf(graph, _convertedGraph.index, index));
    if (drawn)
    {
        _convertedGraph.subtrees.setParts(index, std::move(graph.rasterized));
        _otherParts = _spliced = true;
    }
    if (_convertedGraph.inScene)
        _convertedGraph.inScene->insert(graph.inScene.begin(), graph.inScene.end());
    _convertedGraph.cuttingPlanes |= graph.cuttingPlanes;
    _paged |= graph.paged;
}

/// Keeps the places of uses that have moved in unwatched subtrees.
void ScenePatcher::recordPlaces(const std::vector<MovedUse>& moved)
{
    const Vec3d& origin = _scene->origin;
    const osg::Matrixd engineFromWorld = osg::Matrixd::translate(-origin.x, -origin.y, -origin.z);
    for (const MovedUse& use : moved)
    {
        const TracedGeometry& traced = _convertedGraph.index.at(*use.geometry);
        const uint32_t subtree = traced.uses[use.use].subtree;
        if (subtree == kNoSubtree) continue;
        auto before =
            std::count_if(traced.uses.begin(), traced.uses.begin() + use.use,
                          [subtree](const TracedUse& other) { return other.subtree == subtree; });
        for (ConvertedSubtree::Place& place : _convertedGraph.subtrees.all[subtree].places)
            if (place.geometry == use.geometry && before-- == 0)
                place.hash = placeHash(use.worldFromLocal * engineFromWorld);
    }
}

} // namespace osgRayTrace::engine
