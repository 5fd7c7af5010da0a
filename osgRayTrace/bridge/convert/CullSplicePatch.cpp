// CullSplicePatch.cpp - patches a scene for proxies of cull traversals that came or went. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/ClipPlanes.h"
#include "osgRayTrace/bridge/convert/Enclosures.h"
#include "osgRayTrace/bridge/convert/GraphLengths.h"
#include "osgRayTrace/bridge/convert/SceneBuilder.h"
#include "osgRayTrace/bridge/convert/ScenePatcher.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"

#include <algorithm>
#include <limits>

namespace osgRayTrace::engine
{

namespace
{

/// Returns whether a use may enclose all of a scene, for which it would have no proxy (see
/// Enclosures.h): no mesh of the scene is known to have a corner outside its box. A mesh is asked
/// for its first corner alone.
bool mayEnclose(const Scene& scene, const VertexBounds& bounds, const osg::Matrixd& engineFromLocal)
{
    Vec3d low(std::numeric_limits<double>::infinity()), high = -low;
    for (int corner = 0; corner < 8; ++corner)
    {
        const osg::Vec3d p = osg::Vec3d(corner & 1 ? bounds.high.x : bounds.low.x,
                                        corner & 2 ? bounds.high.y : bounds.low.y,
                                        corner & 4 ? bounds.high.z : bounds.low.z) *
                             engineFromLocal;
        low = glm::min(low, Vec3d(p.x(), p.y(), p.z()));
        high = glm::max(high, Vec3d(p.x(), p.y(), p.z()));
    }
    const Vec3d margin = kEnclosureMargin * (high - low);
    const auto isOutside = [&](const Instance& instance)
    {
        const Mesh& mesh = *scene.meshes[instance.mesh];
        if (mesh.positions.empty()) return false;
        const Vec3d p(transformPoint(instance.engineFromLocal, mesh.positions[0]));
        return glm::any(glm::lessThan(p, low - margin)) ||
               glm::any(glm::greaterThan(p, high + margin));
    };
    return std::none_of(scene.instances.begin(), scene.instances.end(), isOutside);
}

} // namespace

/// Takes out and puts in proxies, and nothing else. What OSG draws needs no patch: it culls the
/// whole subtree in each frame.
bool ScenePatcher::splice(const CullSplice& splice)
{
    if (!splice.removed.empty() || !splice.added.empty()) _spliced = _changed = true;
    for (const ChangedUse& gone : splice.removed)
        if (!removeProxy(gone)) return refuse(ConversionCause::CullTraversal, splice.path);
    if (!splice.added.empty() && !addProxies(splice)) return false;
    _convertedGraph.index.addUntraced({}, splice.left);
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
    for (std::size_t i = 0; i < leaves.size(); ++i)
    {
        const CollectedGeometry& geometry = graph.geometries[i];
        const ConversionCause cause = geometry.geometry == leaves[i].drawable
                                          ? addProxy(graph, geometry)
                                          : ConversionCause::CullTraversal;
        if (cause != ConversionCause::None) return refuseAll(cause);
    }
    if (_convertedGraph.inScene)
        _convertedGraph.inScene->insert(graph.inScene.begin(), graph.inScene.end());
    return true;
}

/// Returns None if the proxy was added, otherwise the cause against it.
ConversionCause ScenePatcher::addProxy(const CollectedGraph& graph,
                                       const CollectedGeometry& geometry)
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
    BuildRules rules;
    rules.linear = !_scene->displayReferred;
    rules.setsColor = _convertedGraph.setsColor;
    rules.comparable = true;
    rules.patches = true;
    rules.now = _now;
    ConversionReport report;
    SceneBuilder(_input, graph, rules, _caches, _convertedGraph, *_scene, report).add(geometry);
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
