// SplicePatch.cpp - patches a scene for nodes that came or went. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/ClipPlanes.h"
#include "osgRayTrace/bridge/convert/GraphLengths.h"
#include "osgRayTrace/bridge/convert/ScenePatcher.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Returns None if a geometry that is on so many paths now can be patched, otherwise the cause
/// against it.
ConversionCause causeToKeep(const TracedGeometry& traced, uint32_t uses)
{
    if (!traced.patchable || traced.culled) return ConversionCause::NotAlone;
    if (!traced.plain) return ConversionCause::Reported;
    return traced.uses.size() == uses ? ConversionCause::None : ConversionCause::OtherPaths;
}

} // namespace

bool ScenePatcher::splice(const GraphSplice& splice)
{
    _spliced = _changed = true;
    return remove(splice) && (splice.added.empty() || add(splice));
}

bool ScenePatcher::remove(const GraphSplice& splice)
{
    // All uses are checked before any is removed, because a removal shortens the lists.
    for (const ChangedUse& gone : splice.removed)
    {
        const auto found = _convertedGraph.index.geometries.find(gone.geometry);
        if (found == _convertedGraph.index.geometries.end())
            return refuse(ConversionCause::OtherPaths, splice.removedFrom);
        const TracedGeometry& traced = found->second;
        const ConversionCause cause = causeToKeep(traced, gone.uses);
        if (cause != ConversionCause::None) return refuse(cause, splice.removedFrom);
    }
    // The last use of each geometry is removed first, so that the uses before it keep their
    // numbers.
    for (auto gone = splice.removed.rbegin(); gone != splice.removed.rend(); ++gone)
    {
        const auto found = _convertedGraph.index.geometries.find(gone->geometry);
        const ConversionCause cause = removeUse(found->second, gone->use);
        if (cause != ConversionCause::None) return refuse(cause, splice.removedFrom);
        if (!found->second.uses.empty()) continue;
        _removed.push_back(found->second.geometry);
        _convertedGraph.index.geometries.erase(found);
        --_geometries;
    }
    return true;
}

/// Returns None if the use was removed, otherwise the cause against it.
ConversionCause ScenePatcher::removeUse(TracedGeometry& traced, uint32_t use)
{
    const TracedUse gone = traced.uses[use];
    if (gone.instance == kInvalid || gone.effects == kInvalid)
        return ConversionCause::NotAnInstance;
    const Instance& instance = _scene->instances[gone.instance];
    if (traced.uses.size() > 1 && !instance.placed) return ConversionCause::NotAnInstance;
    const StateEffects& effects = _convertedGraph.index.stateEffects[gone.effects];
    _convertedGraph.index.removeUse(traced, use);
    if (!effects.counts.empty()) return ConversionCause::Reported; // the report may name paths
    if ((effects.hasAmbient || effects.physical || effects.setsColor) && isLastOf(gone.effects))
        return ConversionCause::LastOfState;

    const uint32_t mesh = instance.mesh;
    removeInstance(gone.instance);
    if (traced.uses.empty()) removeMesh(mesh);
    return ConversionCause::None;
}

void ScenePatcher::removeInstance(uint32_t index)
{
    Instance& instance = _scene->instances[index];
    _leftStatic |= !instance.placed;
    _convertedGraph.materials.release(instance.material);
    instance = Instance();
    instance.mesh = emptyMeshIndex();
    instance.placed = true;
    instance.changed = _now;
    _convertedGraph.instanceGaps.push_back(index);
    --_instances;
}

void ScenePatcher::removeMesh(uint32_t index)
{
    _scene->meshes[index] = emptyMesh();
    _convertedGraph.meshGaps.push_back(index);
}

/// Returns whether no traced use is left that has the same effects on the whole scene, so that they
/// would cease.
bool ScenePatcher::isLastOf(uint32_t effects) const
{
    const StateEffects& gone = _convertedGraph.index.stateEffects[effects];
    bool ambient = gone.hasAmbient, physical = gone.physical, color = gone.setsColor;
    for (const auto& [geometry, traced] : _convertedGraph.index.geometries)
        for (const TracedUse& use : traced.uses)
        {
            if (use.effects == kInvalid || use.instance == kInvalid) continue;
            const StateEffects& other = _convertedGraph.index.stateEffects[use.effects];
            ambient &= !(other.hasAmbient && other.ambient == gone.ambient);
            physical &= !other.physical;
            color &= !other.setsColor;
            if (!ambient && !physical && !color) return false;
        }
    return true;
}

uint32_t ScenePatcher::emptyMeshIndex()
{
    if (_convertedGraph.emptyMesh == kInvalid)
    {
        _convertedGraph.emptyMesh = static_cast<uint32_t>(_scene->meshes.size());
        _scene->meshes.push_back(emptyMesh());
    }
    return _convertedGraph.emptyMesh;
}

/// Finds the bounds of the geometries of a subgraph. Returns false if it has so many vertices that
/// it belongs in the static BVH.
bool ScenePatcher::findBounds(CollectedGraph& graph)
{
    uint64_t vertices = 0;
    for (CollectedGeometry& geometry : graph.geometries)
    {
        geometry.bounds = &_caches.geometries.bounds(*geometry.geometry);
        vertices += geometry.bounds->count;
    }
    return vertices <= kSmallStatic || vertices < _caches.staticVertices;
}

bool ScenePatcher::add(const GraphSplice& splice)
{
    if (_input.assignsMaterials()) // rules look at names
        return refuse(ConversionCause::MaterialFile, splice.added);
    if (_convertedGraph.cullWatch.covers(splice.added))
        return refuse(ConversionCause::CullTraversal, splice.added);
    ConversionReport report;
    GraphCollector collector(_input, _caches.vertices, _caches.triangles, _caches.textures,
                             _caches.rules, report);
    if (!collector.collectAt(fromRoot(splice.added)))
        return refuse(ConversionCause::BadTransform, splice.added);
    CollectedGraph graph = collector.take();
    const LightSources& lights = graph.lights;
    const bool plain = lights.lights.empty() && lights.areaLights.empty() &&
                       lights.environments.empty() && lights.volumes.empty() &&
                       lights.tiles.empty() && graph.rasterized.empty() && !graph.paged &&
                       graph.cullOutcomes.empty() && graph.subtrees.empty() &&
                       report.counts().empty();
    if (!plain) return refuse(ConversionCause::SpecialSubgraph, splice.added);
    graph.texGens = _convertedGraph.texGens;
    if (!findBounds(graph)) return refuse(ConversionCause::LargeSubgraph, splice.added);
    if (!graph.geometries.empty() && !lengthsOf(graph).areOrdinary())
        return refuse(ConversionCause::Lengths, splice.added);
    for (const CollectedGeometry& geometry : graph.geometries)
    {
        const ConversionCause cause = addGeometry(graph, geometry, splice);
        if (cause == ConversionCause::None) continue;
        refuse(cause, splice.added);
        _reason.path = geometry.path;
        return false;
    }
    return true;
}

/// Returns None if the geometry has no state of a kind that the scene lacks, otherwise the cause
/// against it.
ConversionCause ScenePatcher::stateCause(const CollectedGraph& graph,
                                         const CollectedGeometry& geometry) const
{
    const bool automatic = _input.colorRule == RayTraceSettings::AUTOMATIC_COLOR;
    for (const GeometryUse& use : geometry.uses)
    {
        if (clipPlanesOn(graph.states[use.state]) != 0) return ConversionCause::ClipPlanes;
        if (use.proxy) continue;
        const StateEffects effects = stateEffectsOf(graph.states[use.state], _caches.textures);
        if (effects.physical && automatic && _scene->displayReferred)
            return ConversionCause::ColorRule;
        if (effects.setsColor && !_convertedGraph.setsColor) return ConversionCause::CurrentColor;
        if (effects.hasAmbient && effects.ambient != _scene->ambient)
            return ConversionCause::AmbientLight;
    }
    return ConversionCause::None;
}

/// Returns None if the geometry was added, otherwise the cause against it.
ConversionCause ScenePatcher::addGeometry(const CollectedGraph& graph,
                                          const CollectedGeometry& geometry,
                                          const GraphSplice& splice)
{
    const ConversionCause byState = stateCause(graph, geometry);
    if (byState != ConversionCause::None) return byState;
    const auto known = _convertedGraph.index.geometries.find(geometry.geometry);
    const bool isNew = known == _convertedGraph.index.geometries.end();
    if (!isNew)
    {
        const ConversionCause cause =
            causeToKeep(known->second, static_cast<uint32_t>(known->second.uses.size()));
        if (cause != ConversionCause::None) return cause;
    }
    ConversionReport report;
    SceneBuilder builder(_input, graph, patchRules(kNoSubtree), _caches, _convertedGraph, *_scene,
                         report);
    std::vector<ChangedUse> uses;
    for (const ChangedUse& use : splice.uses)
        if (use.geometry == geometry.geometry) uses.push_back(use);
    if (uses.size() != geometry.uses.size()) return ConversionCause::OtherPaths;
    if (isNew)
        builder.add(geometry);
    else
        for (std::size_t i = 0; i < uses.size(); ++i)
            if (uses[i].use > known->second.uses.size() ||
                !builder.addUse(geometry, geometry.uses[i], uses[i].use))
                return ConversionCause::NotAnInstance;
    const TracedGeometry& traced = _convertedGraph.index.at(*geometry.geometry);
    const ConversionCause cause = causeToKeep(traced, uses.front().uses);
    if (cause != ConversionCause::None) return cause;
    const auto isThere = [this](const TracedUse& use)
    { return use.instance != kInvalid && _scene->instances[use.instance].placed; };
    if (!std::all_of(traced.uses.begin(), traced.uses.end(), isThere))
        return ConversionCause::NotAnInstance;
    _geometries += isNew;
    _instances += static_cast<int64_t>(uses.size());
    return report.remarks() == 0 ? ConversionCause::None : ConversionCause::Reported;
}

/// Drops removed geometries from the caches, but keeps those that came back in another place.
void ScenePatcher::dropRemoved()
{
    for (const osg::ref_ptr<const osg::Geometry>& geometry : _removed)
        if (_convertedGraph.index.geometries.count(geometry) == 0)
            _caches.geometries.drop(geometry);
    _caches.vertices.dropUnshared();
    _caches.triangles.dropUnshared();
}

} // namespace osgRayTrace::engine
