// StatePatch.cpp - patches a scene for edits of state. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/MaterialValues.h"
#include "osgRayTrace/bridge/convert/ScenePatcher.h"
#include "osgRayTrace/bridge/graph/Proxies.h"
#include "osgRayTrace/bridge/graph/StatesAbove.h"

#include <utility>

namespace osgRayTrace::engine
{

/// Gives instances the materials of their changed states. If equal materials become one, or one
/// becomes two, the indices of the other materials stay what they are.
bool ScenePatcher::changeStates(const std::vector<StateChange>& uses)
{
    if (uses.empty()) return true;
    if (_input.assignsMaterials()) // rules look at names
        return refuse(ConversionCause::MaterialFile, uses.front().path);
    StateStack states = statesAbove(_input);
    ConversionReport report;
    MaterialConverter converter(
        {!_scene->displayReferred, _input.cullAllRays, _convertedGraph.setsColor}, _caches.textures,
        report);
    for (const StateChange& use : uses)
        if (!changeState(use, states, converter, report)) return false;
    const bool setsColor = _convertedGraph.index.colorUses() > 0; // see MaterialRules
    if (_recolors && setsColor != _convertedGraph.setsColor) // this rule holds for all materials
        return refuse(ConversionCause::CurrentColor, uses.front().path);
    takeNewMaterials();
    return true;
}

/// Gives instances their new materials.
void ScenePatcher::takeNewMaterials()
{
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
    _newMaterials.clear();
}

bool ScenePatcher::changeState(const StateChange& use, StateStack& states,
                               MaterialConverter& converter, ConversionReport& report)
{
    const auto found = _convertedGraph.index.geometries.find(use.geometry);
    const auto refuseUse = [&](ConversionCause cause) { return refuse(cause, use.path); };
    if (found == _convertedGraph.index.geometries.end())
        return refuseUse(ConversionCause::OtherPaths);
    if (!found->second.patchable || found->second.culled)
        return refuseUse(ConversionCause::NotAlone);
    if (found->second.uses.size() != use.uses) return refuseUse(ConversionCause::OtherPaths);
    if (use.looksOnly && _convertedGraph.index.isLeft(*use.geometry)) return true;
    TracedUse& traced = found->second.uses[use.use];
    const bool left = traced.effects == kInvalid;
    if (left && traced.left == kInvalid) return refuseUse(ConversionCause::StateEffects);

    int pushed = 0;
    for (const osg::Node* node : fromRoot(use.path))
        if (const osg::StateSet* stateSet = node->getStateSet())
        {
            states.push(*stateSet);
            ++pushed;
        }
    const GraphState& state = states.states()[states.top()];
    for (; pushed > 0; --pushed)
        states.pop();
    StateEffects effects = stateEffectsOf(state, _caches.textures);
    const Vec3d& origin = _scene->origin;
    const SurfacePlacement place{use.worldFromLocal *
                                     osg::Matrixd::translate(-origin.x, -origin.y, -origin.z),
                                 &_convertedGraph.texGens};
    if (left)
        return changeLeft(use, traced, state, effects, place, converter) ||
               refuseUse(ConversionCause::StateEffects);
    const StateEffects before = _convertedGraph.index.stateEffects[traced.effects];
    if (traced.instance == kInvalid)
        return effects == before || refuseUse(ConversionCause::StateEffects);
    report = ConversionReport();
    const Material material =
        converter.material(state, surfaceInputs(*use.geometry, _input.pointRadius), place);
    effects.counts = report.counts();
    const bool setsColor = std::exchange(effects.setsColor, before.setsColor);
    if (!(effects == before)) return refuseUse(ConversionCause::StateEffects);
    if (setsColor != before.setsColor)
    {
        _recolors = true;
        effects.setsColor = setsColor;
        _convertedGraph.index.setEffects(traced, _convertedGraph.index.effects(effects));
    }
    if (!sameMaterial(material,
                      _convertedGraph.materials[_scene->instances[traced.instance].material]))
        _newMaterials.emplace_back(traced.instance, material);
    return true;
}

/// Gives a proxy the material of its new state. Nothing traced depends on the state of what OSG
/// draws without a proxy. Returns false if more than the material changes, such as who draws it.
bool ScenePatcher::changeLeft(const StateChange& use, const TracedUse& traced,
                              const GraphState& state, StateEffects effects,
                              const SurfacePlacement& place, MaterialConverter& converter)
{
    const StateEffects& before = _convertedGraph.index.stateEffects[traced.left];
    effects.proxied = hasProxy(*use.geometry, fromRoot(use.path), {}, state, _caches.textures);
    if (traced.instance == kInvalid)
        return effects.rasterized == before.rasterized && effects.proxied == before.proxied;
    if (!(effects == before)) return false;
    Material material = converter.material(proxyState(state),
                                           surfaceInputs(*use.geometry, _input.pointRadius), place);
    hideFromCamera(material);
    if (!sameMaterial(material,
                      _convertedGraph.materials[_scene->instances[traced.instance].material]))
        _newMaterials.emplace_back(traced.instance, material);
    return true;
}

} // namespace osgRayTrace::engine
