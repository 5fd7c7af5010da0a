// SceneConverter.cpp - converts a graph to a Scene, and its changes to the next Scene. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/SceneConverter.h"

#include "osgRayTrace/base/ThreadSeam.h"
#include "osgRayTrace/bridge/common/SceneExtent.h"
#include "osgRayTrace/bridge/convert/ConversionState.h"
#include "osgRayTrace/bridge/convert/Enclosures.h"
#include "osgRayTrace/bridge/convert/GraphLengths.h"
#include "osgRayTrace/bridge/convert/GraphTraits.h"
#include "osgRayTrace/bridge/convert/GroundPlane.h"
#include "osgRayTrace/bridge/convert/SceneBuilder.h"
#include "osgRayTrace/bridge/convert/SceneLights.h"
#include "osgRayTrace/bridge/convert/ScenePatcher.h"
#include "osgRayTrace/bridge/convert/SnapshotStamps.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"
#include "osgRayTrace/bridge/pick/PickIndex.h"

#include <algorithm>
#include <chrono>

namespace osgRayTrace::engine
{

namespace
{

void setBounds(CollectedGraph& graph, GeometryCache& geometries)
{
    for (CollectedGeometry& geometry : graph.geometries)
        geometry.bounds = &geometries.bounds(*geometry.geometry);
}

void beginCollection(ConversionCaches& caches)
{
    caches.vertices.begin();
    caches.triangles.begin();
    caches.rules.begin();
    caches.closedMeshes.begin();
}

/// Forgets in the caches what the graph no longer has.
void endCollection(ConversionCaches& caches)
{
    caches.vertices.end();
    caches.triangles.end();
    caches.rules.end();
    caches.closedMeshes.end();
}

/// Returns the parts that OSG has to draw; null: the parts show nothing.
std::shared_ptr<const RasterizedParts>
shownParts(const std::shared_ptr<const RasterizedParts>& parts)
{
    const auto shows = [](const RasterizedPart& part)
    { return part.kind == RasterizedPart::Draw || part.kind == RasterizedPart::Clear; };
    return std::any_of(parts->begin(), parts->end(), shows) ? parts : nullptr;
}

double secondsSince(std::chrono::steady_clock::time_point begin)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Returns whether a scene made by the rules has the coordinates and the colours of the last one.
bool isComparable(const Scene& last, const Vec3d& origin, const BuildRules& rules)
{
    return !last.instances.empty() && last.origin == origin && last.unit == rules.unit &&
           last.displayReferred == !rules.linear;
}

/// Sets whence the graph is seen now: levels of detail and billboards depend on that.
void takeView(const ViewingConditions& conditions, ConversionInput& input)
{
    input.eye = conditions.eye;
    input.view = conditions.view;
    input.pass = conditions.pass;
    input.inheritedState = conditions.inheritedState;
}

void addToCount(ConversionCounts& counts, const std::string& what, int64_t more)
{
    if (more == 0) return;
    uint64_t& count = counts[what];
    count += static_cast<uint64_t>(more);
    if (count == 0) counts.erase(what);
}

} // namespace

struct SceneConverter::Implementation
{
    ConversionCaches caches;
    ConvertedGraph convertedGraph;
    ConversionInput input; ///< input of the last conversion
    std::shared_ptr<const Scene> last;
    ConversionResult lastResult;
    uint64_t forgotten = 0; ///< meshes that were made before the caches were emptied
    bool ordinary = false;  ///< true: unit is 1, and stays so as long as lengths are ordinary
    Stamp stamp = 0;
    ThreadSeam seam;
};

SceneConverter::SceneConverter() : _implementation(std::make_unique<Implementation>()) {}

SceneConverter::~SceneConverter() = default;

void SceneConverter::releaseGraph()
{
    const ThreadSeam::Entry inside(_implementation->seam);
    Implementation& state = *_implementation;
    state.convertedGraph = ConvertedGraph();
    state.caches.vertices = SoftwareVertices();
    state.caches.rules = RuleCaches();
    state.caches.triangles = DrawableTriangles();
    state.lastResult = ConversionResult();
    state.input = ConversionInput();
    state.ordinary = false; // prevents patches
}

void SceneConverter::forget()
{
    const ThreadSeam::Entry inside(_implementation->seam);
    _implementation->forgotten = convertedMeshes();
    _implementation->caches = ConversionCaches();
}

CullChanges SceneConverter::lookInCull(const ViewingConditions& conditions)
{
    const ThreadSeam::Entry inside(_implementation->seam);
    Implementation& state = *_implementation;
    CullWatch& watch = state.convertedGraph.cullWatch;
    if (watch.isEmpty()) return {};
    ConversionInput input = state.input;
    takeView(conditions, input);
    ConversionCaches& caches = state.caches;
    return watch.look(input, {caches.vertices, caches.triangles, caches.textures, caches.rules});
}

ConvertedNodes SceneConverter::convertedNodes() const
{
    const ConvertedGraph& graph = _implementation->convertedGraph;
    return {graph.cullWatch.captured(), graph.inScene ? &*graph.inScene : nullptr,
            graph.cuttingPlanes,
            [&graph](const osg::Geometry& geometry) { return graph.index.isLeft(geometry); }};
}

void SceneConverter::addCullChanges(const CullChanges& cull, GraphChanges& changes) const
{
    const SceneIndex& index = _implementation->convertedGraph.index;
    const auto isFollowed = [&](const osg::Geometry* geometry)
    { return index.isFollowedInCull(*geometry, cull.complete); };
    changes.moved.erase(std::remove_if(changes.moved.begin(), changes.moved.end(),
                                       [&](const MovedUse& use)
                                       { return isFollowed(use.geometry); }),
                        changes.moved.end());
    changes.deformed.erase(
        std::remove_if(changes.deformed.begin(), changes.deformed.end(), isFollowed),
        changes.deformed.end());
    changes.moved.insert(changes.moved.end(), cull.moved.begin(), cull.moved.end());
    changes.deformed.insert(changes.deformed.end(), cull.deformed.begin(), cull.deformed.end());
    changes.culled.insert(changes.culled.end(), cull.splices.begin(), cull.splices.end());
    for (const osg::NodePath& path : cull.others)
        changes.subtrees.push_back({ConversionCause::CullTraversal, path});
    if (cull.holds || changes.convert) return;
    changes.convert = true;
    changes.reason.cause = ConversionCause::CullTraversal;
}

uint64_t SceneConverter::convertedMeshes() const
{
    return _implementation->forgotten + _implementation->caches.geometries.converted();
}

ConversionResult SceneConverter::convert(const ConversionInput& input)
{
    const ThreadSeam::Entry inside(_implementation->seam);
    const auto begin = std::chrono::steady_clock::now();
    Implementation& state = *_implementation;
    state.convertedGraph = ConvertedGraph();
    state.input = input;
    BuildRules rules;
    rules.now = ++state.stamp;

    ConversionReport report;
    beginCollection(state.caches);
    GraphCollector collector(input, state.caches.vertices, state.caches.triangles,
                             state.caches.textures, state.caches.rules, report);
    if (input.root) input.root->accept(collector);
    CollectedGraph graph = collector.take();

    rules.linear = isLinear(graph, input.colorRule);
    rules.setsColor = state.convertedGraph.setsColor = setsColor(graph);
    state.caches.geometries.begin(rules.now);
    setBounds(graph, state.caches.geometries);
    if (graph.hasProxies) dropEnclosures(graph, input);
    const LengthCounts lengths = lengthsOf(graph);
    rules.unit = lengths.unit();
    applyUnit(rules.unit, graph);
    state.caches.textures.begin(rules.linear, rules.now);
    const Vec3d origin(input.origin.x(), input.origin.y(), input.origin.z());
    rules.comparable = state.last && isComparable(*state.last, origin, rules);
    const auto scene = std::make_shared<Scene>();
    SceneBuilder builder(input, graph, rules, state.caches, state.convertedGraph, *scene, report);
    builder.build();
    state.convertedGraph.materials.takeChanged();
    ConversionReport lightReport;
    setLights(*scene, input, graph.lights, state.caches, lightReport);
    scene->ground = groundOf(input.ground, *scene);
    warnWithoutShadows(*scene);
    report.add(lightReport);
    report.count("converted.light", scene->lights.size() - viewerLights(lightReport.counts()));
    state.last = stampChanges(scene, state.last, rules.now);
    state.caches.geometries.end();
    ConversionResult result;
    if (input.picks) result.pickIndex = std::make_shared<PickIndex>(graph, builder.instances());
    state.ordinary = rules.unit == 1.0 && lengths.areOrdinary();
    state.convertedGraph.lights = std::move(graph.lights);
    state.convertedGraph.lightCounts = lightReport.counts();
    state.convertedGraph.clearColor = graph.clearColor;
    state.convertedGraph.inScene = std::move(graph.inScene);
    state.convertedGraph.texGens = graph.texGens;
    dropDoubtful(graph.enclosures, *scene);
    state.convertedGraph.subtrees.record(graph);
    state.convertedGraph.clipPlanes = graph.clipPlanes;
    state.convertedGraph.cuttingPlanes = graph.cuttingPlanes;
    state.convertedGraph.unwatchedPlanes = graph.unwatchedPlanes;
    state.convertedGraph.cullWatch.record(graph,
                                          input.materials ? input.materials->reads : nullptr);
    state.convertedGraph.index.addUntraced(graph.rasterized, graph.leftGeometries);
    endCollection(state.caches);

    result.scene = state.last;
    result.paged = graph.paged;
    result.counts = report.counts();
    result.paths = report.paths();
    warnOnceAReason(report, input.rasterizesRest);
    state.convertedGraph.subtrees.parts =
        std::make_shared<const RasterizedParts>(std::move(graph.rasterized));
    result.rasterized = shownParts(state.convertedGraph.subtrees.parts);
    result.seconds = secondsSince(begin);
    state.lastResult = result;
    return result;
}

PatchResult SceneConverter::patch(const GraphChanges& changes, const ViewingConditions& conditions)
{
    const ThreadSeam::Entry inside(_implementation->seam);
    const auto begin = std::chrono::steady_clock::now();
    Implementation& state = *_implementation;
    const auto refused = [](ConversionCause cause) {
        return PatchResult{std::nullopt, {cause, {}, nullptr, 0}};
    };
    const auto losesStaticBvh = [&state]
    { return state.caches.noStaticBvh && !state.caches.staticMeshes.empty(); };
    const bool patchable = state.ordinary || changes.isOfTheView();
    if (!state.last || !patchable) return refused(ConversionCause::NotPatchable);
    if (losesStaticBvh()) return refused(ConversionCause::NoStaticBvh);
    takeView(conditions, state.input);
    if (changes.view)
    {
        state.input.clearColor = changes.view->clearColor;
        state.input.viewLight = changes.view->light;
    }
    ScenePatcher patcher(*state.last, state.input, state.caches, state.convertedGraph,
                         ++state.stamp);
    const std::shared_ptr<const Scene> scene = patcher.patch(changes);
    if (!scene) return {std::nullopt, patcher.reason()};
    if (patcher.changed()) state.last = scene;
    if (patcher.leftStatic()) recordStaticMeshes(*scene, true, state.caches);
    if (losesStaticBvh()) return refused(ConversionCause::NoStaticBvh);
    ConversionResult& result = state.lastResult;
    result.scene = state.last;
    if (patcher.spliced() || !changes.subtrees.empty()) result.pickIndex.reset();
    addToCount(result.counts, "converted.geometry", patcher.geometriesMore());
    addToCount(result.counts, "converted.instance", patcher.instancesMore());
    addToCount(result.counts, "traced.proxy", patcher.proxiesMore());
    for (const CullSplice& splice : changes.culled)
        for (const auto& [reason, more] : splice.countsMore)
            addToCount(result.counts, reason, more);
    for (const auto& [reason, more] : patcher.countsMore())
        addToCount(result.counts, reason, more);
    if (patcher.otherParts()) result.rasterized = shownParts(state.convertedGraph.subtrees.parts);
    result.paged |= patcher.paged();
    result.counts["converted.light"] =
        state.last->lights.size() - viewerLights(state.convertedGraph.lightCounts);
    result.emptyInstances = state.convertedGraph.instanceGaps.size();
    result.emptyMeshes =
        state.convertedGraph.meshGaps.size() + (state.convertedGraph.emptyMesh == kInvalid ? 0 : 1);
    result.seconds = secondsSince(begin);
    return {result, {}};
}

} // namespace osgRayTrace::engine
