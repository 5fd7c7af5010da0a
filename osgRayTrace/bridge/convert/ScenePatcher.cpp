// ScenePatcher.cpp - edits of state, of lights and of which nodes there are. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/ScenePatcher.h"

#include "osgRayTrace/bridge/appearance/lights/LightConverter.h"
#include "osgRayTrace/bridge/appearance/materials/MaterialValues.h"
#include "osgRayTrace/bridge/common/NodePathText.h"
#include "osgRayTrace/bridge/convert/PlacePatcher.h"
#include "osgRayTrace/bridge/convert/SceneBuilder.h"
#include "osgRayTrace/bridge/convert/SceneLights.h"
#include "osgRayTrace/bridge/convert/SnapshotStamps.h"

#include <osgRayTrace/AreaLight>

#include <algorithm>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Of what came, in units of the world.
LengthCounts lengthsOf(const CollectedGraph& graph)
{
    LengthCounts lengths;
    for (const CollectedGeometry& geometry : graph.geometries)
        for (const GeometryUse& use : geometry.uses)
            if (geometry.bounds->count > 0)
                lengths.add(largestCoordinate(*geometry.bounds, use.engineFromLocal),
                            geometry.bounds->count);
    return lengths;
}

bool anyShines(const std::vector<Light>& lights)
{
    return std::any_of(lights.begin(), lights.end(),
                       [](const Light& light) { return light.instance != kInvalid; });
}

osg::NodePath fromRoot(const osg::NodePath& path, osg::Node* root)
{
    osg::NodePath whole = path;
    if (whole.front() != root) whole.insert(whole.begin(), root);
    return whole;
}

/// None: a geometry can be patched that is on so many paths now.
ConversionCause causeToKeep(const TracedGeometry& traced, uint32_t uses)
{
    if (!traced.patchable) return ConversionCause::NotAlone;
    if (!traced.plain) return ConversionCause::Reported;
    return traced.uses.size() == uses ? ConversionCause::None : ConversionCause::OtherPaths;
}

} // namespace

ScenePatcher::ScenePatcher(const Scene& last, const ConversionInput& input,
                           ConversionCaches& caches, ConvertedGraph& convertedGraph, Stamp now)
    : _last(last),
      _input(input),
      _caches(caches),
      _convertedGraph(convertedGraph),
      _now(now),
      _scene(std::make_shared<Scene>(last))
{
}

/// False. path: from the first node that was found; empty: of no single node.
bool ScenePatcher::refuse(ConversionCause cause, const osg::NodePath& path)
{
    _reason.cause = cause;
    if (!path.empty()) _reason.path = pathText(fromRoot(path, _input.root));
    return false;
}

bool ScenePatcher::refuse(ConversionCause cause, const osg::Geometry& geometry, uint32_t use)
{
    _reason = {cause, {}, &geometry, use};
    return false;
}

/// path: as the collector gives it.
bool ScenePatcher::refuseLamp(const std::string& path)
{
    _reason = {ConversionCause::LampShape, path, nullptr, 0};
    return false;
}

std::shared_ptr<Scene> ScenePatcher::patch(const GraphChanges& changes)
{
    _caches.geometries.begin(_now);
    _caches.textures.resume(_now);
    for (const GraphSplice& one : changes.splices)
        if (!splice(one)) return nullptr;
    takeMaterials();
    if (!moveAndDeform(changes) || !changeStates(changes.stateChanges)) return nullptr;
    if (changes.lights && !relightLamps()) return nullptr;
    takeMaterials();
    const bool relights = changes.lights || _spliced || !changes.stateChanges.empty();
    if (relights && !relight()) return nullptr;
    dropRemoved();
    if (_changed) _scene->changed = _now;
    return std::move(_scene);
}

bool ScenePatcher::moveAndDeform(const GraphChanges& changes)
{
    PlacePatcher places(*_scene, _convertedGraph.index, _caches.geometries, _now);
    for (const osg::Geometry* geometry : changes.deformed)
        _caches.geometries.recordMobility(*geometry, Mobility::Deforming);
    for (const MovedUse& use : changes.moved)
        if (!places.move(use)) return refuse(places.cause(), *use.geometry, use.use);
    for (const osg::Geometry* geometry : changes.deformed)
        if (!places.deform(*geometry)) return refuse(places.cause(), *geometry, 0);
    _changed |= places.changed();
    _leftStatic |= places.leftStatic();
    return true;
}

/// Where equal materials become one, or one becomes two, indices of others stay what they are.
bool ScenePatcher::changeStates(const std::vector<StateChange>& uses)
{
    if (uses.empty()) return true;
    if (_input.materials) // rules look at names
        return refuse(ConversionCause::MaterialFile, uses.front().path);
    StateStack states = statesAbove(_input);
    ConversionReport report;
    MaterialConverter converter(
        {!_scene->displayReferred, _input.cullAllRays, _convertedGraph.setsColor}, _caches.textures,
        report);
    for (const StateChange& use : uses)
        if (!changeState(use, states, converter, report)) return false;
    if (_recolors && setsColor() != _convertedGraph.setsColor) // a rule of all materials
        return refuse(ConversionCause::CurrentColor, uses.front().path);
    for (const auto& [instance, material] : _newMaterials)
        _convertedGraph.materials.release(_scene->instances[instance].material);
    for (const auto& [index, material] : _newMaterials)
    {
        Instance& instance = _scene->instances[index];
        const uint32_t before = instance.material;
        instance.material = _convertedGraph.materials.add(material);
        if (instance.material == before) continue;
        instance.changed = _now;
        _changed = true;
    }
    return true;
}

/// Whether a state of the scene makes another colour current: see MaterialRules.
bool ScenePatcher::setsColor() const
{
    const std::vector<StateEffects>& stateEffects = _convertedGraph.index.stateEffects;
    for (const auto& [geometry, traced] : _convertedGraph.index.geometries)
        for (const TracedUse& use : traced.uses)
            if (use.effects != kInvalid && stateEffects[use.effects].setsColor) return true;
    return false;
}

bool ScenePatcher::changeState(const StateChange& use, StateStack& states,
                               MaterialConverter& converter, ConversionReport& report)
{
    const auto found = _convertedGraph.index.geometries.find(use.geometry);
    const auto refuseUse = [&](ConversionCause cause) { return refuse(cause, use.path); };
    if (found == _convertedGraph.index.geometries.end())
        return refuseUse(ConversionCause::OtherPaths);
    if (!found->second.patchable) return refuseUse(ConversionCause::NotAlone);
    if (found->second.uses.size() != use.uses) return refuseUse(ConversionCause::OtherPaths);
    TracedUse& traced = found->second.uses[use.use];
    if (traced.effects == kInvalid) return refuseUse(ConversionCause::StateEffects);

    int pushed = 0;
    for (const osg::Node* node : fromRoot(use.path, _input.root))
        if (const osg::StateSet* stateSet = node->getStateSet())
        {
            states.push(*stateSet);
            ++pushed;
        }
    const GraphState& state = states.states()[states.top()];
    for (; pushed > 0; --pushed)
        states.pop();
    StateEffects effects = stateEffectsOf(state, _caches.textures);
    const StateEffects before = _convertedGraph.index.stateEffects[traced.effects];
    if (traced.instance == kInvalid)
        return effects == before || refuseUse(ConversionCause::StateEffects);
    const Vec3d& origin = _scene->origin;
    report = ConversionReport();
    const Material material = converter.material(
        state, surfaceInputs(*use.geometry),
        {use.worldFromLocal * osg::Matrixd::translate(-origin.x, -origin.y, -origin.z),
         &_convertedGraph.texGens});
    effects.counts = report.counts();
    const bool setsColor = std::exchange(effects.setsColor, before.setsColor);
    if (!(effects == before)) return refuseUse(ConversionCause::StateEffects);
    if (setsColor != before.setsColor)
    {
        _recolors = true;
        effects.setsColor = setsColor;
        traced.effects = _convertedGraph.index.effects(effects);
    }
    if (!sameMaterial(material,
                      _convertedGraph.materials[_scene->instances[traced.instance].material]))
        _newMaterials.emplace_back(traced.instance, material);
    return true;
}

/// Of area lights; their places and shapes are a matter of the whole graph.
bool ScenePatcher::relightLamps()
{
    for (std::size_t i = 0; i < _convertedGraph.lights.areaLights.size(); ++i)
    {
        const CollectedAreaLight& source = _convertedGraph.lights.areaLights[i];
        ConversionCaches::Quad& quad = _caches.areaLights[i];
        const auto converted = convertAreaLight(*source.light, source.engineFromLocal);
        if (converted.has_value() != (quad.instance != kInvalid)) return refuseLamp(source.path);
        if (!converted) continue;
        if (!std::equal(quad.mesh->positions.begin(), quad.mesh->positions.end(),
                        converted->mesh->positions.begin()))
            return refuseLamp(source.path);
        quad.light = converted->light;
        Instance& instance = _scene->instances[quad.instance];
        const Material lamp = lampMaterial(quad.light.radiance);
        if (sameMaterial(lamp, _convertedGraph.materials[instance.material])) continue;
        _convertedGraph.materials.release(instance.material);
        instance.material = _convertedGraph.materials.add(lamp);
        instance.changed = _now;
        _changed = true;
    }
    return true;
}

/// Those that have changed, and their textures.
void ScenePatcher::takeMaterials()
{
    const std::vector<uint32_t> exchanged = _convertedGraph.materials.takeChanged();
    const std::vector<Material>& all = _convertedGraph.materials.all();
    if (!exchanged.empty())
    {
        if (!all.empty()) _scene->materials.resize(all.size());
        for (const uint32_t index : exchanged)
        {
            _scene->materials[index] = all[index];
            _scene->materials[index].changed = _now;
        }
        _caches.textures.keepOnly(
            _convertedGraph.materials.usedTextures(_caches.textures.all().size()));
        _changed = true;
    }
    if (_scene->textures == _caches.textures.all()) return;
    _scene->textures = _caches.textures.all();
    _changed = true;
}

bool ScenePatcher::relight()
{
    ConversionReport report;
    setLights(*_scene, _input, _convertedGraph.lights, _caches, report);
    if (report.counts() != _convertedGraph.lightCounts)
        return refuse(ConversionCause::LightReport, {});
    _changed |= stampLights(_scene->lights, _last.lights, _now);
    if (!anyShines(_last.lights) && !anyShines(_scene->lights)) return true;
    const std::size_t count = std::min(_last.instances.size(), _scene->instances.size());
    for (std::size_t i = 0; i < count; ++i)
        if (_scene->instances[i].light != _last.instances[i].light)
            _scene->instances[i].changed = _now;
    return true;
}

bool ScenePatcher::splice(const GraphSplice& splice)
{
    _spliced = _changed = true;
    return remove(splice) && (splice.added.empty() || add(splice));
}

bool ScenePatcher::remove(const GraphSplice& splice)
{
    // Before any goes: those that follow shorten the lists.
    for (const ChangedUse& gone : splice.removed)
    {
        const auto found = _convertedGraph.index.geometries.find(gone.geometry);
        if (found == _convertedGraph.index.geometries.end())
            return refuse(ConversionCause::OtherPaths, splice.removedFrom);
        const TracedGeometry& traced = found->second;
        const ConversionCause cause = causeToKeep(traced, gone.uses);
        if (cause != ConversionCause::None) return refuse(cause, splice.removedFrom);
    }
    // The last of each first: those before it keep their numbers.
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

/// None: it was removed.
ConversionCause ScenePatcher::removeUse(TracedGeometry& traced, uint32_t use)
{
    const TracedUse gone = traced.uses[use];
    if (gone.instance == kInvalid || gone.effects == kInvalid)
        return ConversionCause::NotAnInstance;
    Instance& instance = _scene->instances[gone.instance];
    if (traced.uses.size() > 1 && !instance.placed) return ConversionCause::NotAnInstance;
    const StateEffects& effects = _convertedGraph.index.stateEffects[gone.effects];
    traced.uses.erase(traced.uses.begin() + use);
    if (!effects.counts.empty()) return ConversionCause::Reported; // paths may be named
    if ((effects.hasAmbient || effects.physical || effects.setsColor) && isLastOf(gone.effects))
        return ConversionCause::LastOfState;

    _leftStatic |= !instance.placed;
    _convertedGraph.materials.release(instance.material);
    const uint32_t mesh = instance.mesh;
    instance = Instance();
    instance.mesh = emptyMeshIndex();
    instance.placed = true;
    instance.changed = _now;
    _convertedGraph.instanceGaps.push_back(gone.instance);
    --_instances;
    if (!traced.uses.empty()) return ConversionCause::None;
    _scene->meshes[mesh] = emptyMesh();
    _convertedGraph.meshGaps.push_back(mesh);
    return ConversionCause::None;
}

/// Whether no other use has these effects: what it alone decides for all of the scene would
/// change.
bool ScenePatcher::isLastOf(uint32_t effects) const
{
    for (const auto& [geometry, traced] : _convertedGraph.index.geometries)
        for (const TracedUse& use : traced.uses)
            if (use.effects == effects && use.instance != kInvalid) return false;
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

bool ScenePatcher::add(const GraphSplice& splice)
{
    if (_input.materials) // rules look at names
        return refuse(ConversionCause::MaterialFile, splice.added);
    ConversionReport report;
    GraphCollector collector(_input, _caches.vertices, _caches.textures, report);
    if (!collector.collectAt(fromRoot(splice.added, _input.root)))
        return refuse(ConversionCause::BadTransform, splice.added);
    CollectedGraph graph = collector.take();
    const LightSources& lights = graph.lights;
    const bool plain = lights.lights.empty() && lights.areaLights.empty() &&
                       lights.environments.empty() && graph.rasterized.empty() && !graph.paged &&
                       report.counts().empty();
    if (!plain) return refuse(ConversionCause::SpecialSubgraph, splice.added);
    graph.texGens = _convertedGraph.texGens;
    uint64_t vertices = 0;
    for (CollectedGeometry& geometry : graph.geometries)
    {
        geometry.bounds = &_caches.geometries.bounds(*geometry.geometry);
        vertices += geometry.bounds->count;
    }
    // So much shall be flat.
    if (vertices > kSmallStatic && vertices >= _caches.staticVertices)
        return refuse(ConversionCause::LargeSubgraph, splice.added);
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

/// None: state of another kind than the scene has is not among it.
ConversionCause ScenePatcher::stateCause(const CollectedGraph& graph,
                                         const CollectedGeometry& geometry) const
{
    const bool automatic = _input.colorRule == RayTraceSettings::AUTOMATIC_COLOR;
    for (const GeometryUse& use : geometry.uses)
    {
        const StateEffects effects = stateEffectsOf(graph.states[use.state], _caches.textures);
        if (effects.physical && automatic && _scene->displayReferred)
            return ConversionCause::ColorRule;
        if (effects.setsColor && !_convertedGraph.setsColor) return ConversionCause::CurrentColor;
        if (effects.hasAmbient && effects.ambient != _scene->ambient)
            return ConversionCause::AmbientLight;
        if (effects.clipPlanes != 0) return ConversionCause::ClipPlanes;
    }
    return ConversionCause::None;
}

/// None: it was added.
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
    BuildRules rules;
    rules.linear = !_scene->displayReferred;
    rules.setsColor = _convertedGraph.setsColor;
    rules.comparable = true;
    rules.now = _now;
    SceneBuilder builder(_input, graph, rules, _caches, _convertedGraph, *_scene, report);
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

/// What came back in another place is kept.
void ScenePatcher::dropRemoved()
{
    for (const osg::ref_ptr<const osg::Geometry>& geometry : _removed)
        if (_convertedGraph.index.geometries.count(geometry) == 0)
            _caches.geometries.drop(geometry);
}

} // namespace osgRayTrace::engine
