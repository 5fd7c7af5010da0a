// SubtreeComparison.cpp - compares what was collected with what the scene has of it. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/SubtreeComparison.h"

#include "osgRayTrace/bridge/appearance/materials/MaterialValues.h"
#include "osgRayTrace/bridge/convert/SceneBuilder.h"

namespace osgRayTrace::engine
{

std::vector<uint32_t> usesIn(const TracedGeometry& traced, uint32_t subtree)
{
    std::vector<uint32_t> uses;
    for (uint32_t i = 0; i < traced.uses.size(); ++i)
        if (traced.uses[i].subtree == subtree) uses.push_back(i);
    return uses;
}

SubtreeComparison::SubtreeComparison(const ConversionInput& input, const CollectedGraph& graph,
                                     const Scene& scene, ConversionCaches& caches,
                                     const ConvertedGraph& convertedGraph, uint32_t subtree)
    : _input(input),
      _graph(graph),
      _scene(scene),
      _caches(caches),
      _convertedGraph(convertedGraph),
      _subtree(subtree),
      _materials({!scene.displayReferred, input.cullAllRays, convertedGraph.setsColor},
                 caches.textures, _report)
{
    for (const ConvertedSubtree::Place& place : convertedGraph.subtrees.all[subtree].places)
        _places[place.geometry].push_back(place.hash);
}

bool SubtreeComparison::isSame(const CollectedGeometry& geometry)
{
    const auto found = _convertedGraph.index.geometries.find(geometry.geometry);
    if (found == _convertedGraph.index.geometries.end()) return false;
    const TracedGeometry& traced = found->second;
    const std::vector<uint32_t> uses = usesIn(traced, _subtree);
    const std::vector<uint64_t>& places = _places[geometry.geometry];
    if (uses.size() != geometry.uses.size() || places.size() < uses.size()) return false;
    const MeshRequest* request = _caches.geometries.lastRequest(*geometry.geometry);
    if (!request || !(request->restart == geometry.restart) ||
        request->pointRadius != geometry.pointRadius ||
        !_caches.geometries.isCurrent(*geometry.geometry))
        return false;
    const std::size_t materials = _others.size();
    for (std::size_t i = 0; i < uses.size(); ++i)
    {
        const GeometryUse& use = geometry.uses[i];
        if (placeHash(use.engineFromLocal) == places[i] &&
            isSame(geometry, use, traced.uses[uses[i]]))
            continue;
        _others.resize(materials);
        return false;
    }
    return true;
}

bool SubtreeComparison::isSame(const CollectedGeometry& geometry, const GeometryUse& use,
                               const TracedUse& traced)
{
    if (use.proxy != (traced.effects == kInvalid)) return false;
    StateEffects effects = stateEffectsOf(_graph.states[use.state], _caches.textures);
    effects.proxied = use.proxy;
    if (traced.instance == kInvalid)
        return use.proxy || effects == _convertedGraph.index.stateEffects[traced.effects];
    _report = ConversionReport();
    Material material =
        materialOf(_materials, use, _graph, surfaceInputs(*geometry.geometry, _input.pointRadius));
    if (!use.proxy) effects.counts = _report.counts();
    const uint32_t before = use.proxy ? traced.left : traced.effects;
    if (!(effects == _convertedGraph.index.stateEffects[before])) return false;
    const uint32_t now = _scene.instances[traced.instance].material;
    if (!sameMaterial(material, _convertedGraph.materials[now]))
        _others.emplace_back(traced.instance, std::move(material));
    return true;
}

} // namespace osgRayTrace::engine
