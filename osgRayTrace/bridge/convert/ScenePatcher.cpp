// ScenePatcher.cpp - patches a scene for edits of lights, and takes over materials. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/ScenePatcher.h"

#include "osgRayTrace/bridge/appearance/lights/LightConverter.h"
#include "osgRayTrace/bridge/appearance/materials/MaterialValues.h"
#include "osgRayTrace/bridge/common/NodePathText.h"
#include "osgRayTrace/bridge/convert/Background.h"
#include "osgRayTrace/bridge/convert/Enclosures.h"
#include "osgRayTrace/bridge/convert/PlacePatcher.h"
#include "osgRayTrace/bridge/convert/SceneLights.h"
#include "osgRayTrace/bridge/convert/SnapshotStamps.h"

#include <algorithm>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

bool anyShines(const std::vector<Light>& lights)
{
    return std::any_of(lights.begin(), lights.end(),
                       [](const Light& light) { return light.instance != kInvalid; });
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

/// Returns the rules by which a SceneBuilder adds to the scene. subtree is the unwatched subtree of
/// what it adds, or kNoSubtree.
BuildRules ScenePatcher::patchRules(uint32_t subtree) const
{
    BuildRules rules;
    rules.linear = !_scene->displayReferred;
    rules.setsColor = _convertedGraph.setsColor;
    rules.comparable = true;
    rules.patches = true;
    rules.subtree = subtree;
    rules.now = _now;
    return rules;
}

osg::NodePath ScenePatcher::fromRoot(const osg::NodePath& path) const
{
    osg::NodePath whole = path;
    if (whole.front() != _input.root) whole.insert(whole.begin(), _input.root);
    return whole;
}

/// Records the cause and returns false. path begins at the first node that was found; an empty path
/// means that no single node is the cause.
bool ScenePatcher::refuse(ConversionCause cause, const osg::NodePath& path)
{
    _reason.cause = cause;
    if (!path.empty()) _reason.path = pathText(fromRoot(path));
    return false;
}

bool ScenePatcher::refuse(ConversionCause cause, const osg::Geometry& geometry, uint32_t use)
{
    _reason = {cause, {}, &geometry, use};
    return false;
}

/// Records that a lamp is the cause and returns false. path is the collector's text.
bool ScenePatcher::refuseLamp(const std::string& path)
{
    _reason = {ConversionCause::LampShape, path, nullptr, 0};
    return false;
}

std::shared_ptr<Scene> ScenePatcher::patch(const GraphChanges& changes)
{
    _caches.geometries.begin(_now);
    _caches.textures.resume(_now);
    _caches.vertices.begin(); // each patch asks drawables again
    _caches.triangles.begin();
    for (const GraphSplice& one : changes.splices)
        if (!splice(one)) return nullptr;
    for (const CullSplice& one : changes.culled)
        if (!splice(one)) return nullptr;
    takeMaterials();
    if (!moveAndDeform(changes) || !changeStates(changes.stateChanges)) return nullptr;
    if (!recut(changes.clips)) return nullptr;
    for (const ChangedSubtree& one : changes.subtrees)
        if (!redo(one)) return nullptr;
    if (!encloseStill(changes.moved)) return nullptr;
    for (const uint32_t effects : _goneEffects)
        if (isLastOf(effects))
        {
            refuse(ConversionCause::LastOfState, {});
            return nullptr;
        }
    if (changes.lights && !relightLamps()) return nullptr;
    takeMaterials();
    if (changes.view) setBackground();
    const bool relights = changes.lights || changes.view || _spliced ||
                          !changes.stateChanges.empty() || !changes.subtrees.empty();
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
    recordPlaces(changes.moved);
    _changed |= places.changed();
    _leftStatic |= places.leftStatic();
    return true;
}

/// Returns false if something has left what was known to enclose the scene, which has a proxy then,
/// or if nothing is left outside of a proxy. Lights and the shape of what encloses the scene are
/// not looked at again: see mayEnclose.
bool ScenePatcher::encloseStill(const std::vector<MovedUse>& moved)
{
    std::vector<Enclosure>& enclosures = _convertedGraph.subtrees.enclosures;
    enclosures.erase(std::remove_if(enclosures.begin(), enclosures.end(),
                                    [](const Enclosure& one) // that nobody else holds
                                    { return one.geometry->referenceCount() == 1; }),
                     enclosures.end());
    const Vec3d& origin = _scene->origin;
    const osg::Matrixd engineFromWorld = osg::Matrixd::translate(-origin.x, -origin.y, -origin.z);
    for (const MovedUse& use : moved)
        if (Enclosure* enclosure = _convertedGraph.subtrees.enclosure(*use.geometry))
        {
            enclosure->engineFromLocal = use.worldFromLocal * engineFromWorld;
            enclosure->moved = true;
        }
    for (Enclosure& enclosure : enclosures)
    {
        const bool other = std::exchange(enclosure.moved, false);
        const Stamp since = other || !enclosure.encloses ? 0 : _now;
        if (mayEnclose(*_scene, enclosure.bounds, enclosure.engineFromLocal, since) !=
            enclosure.encloses)
            return refuse(ConversionCause::Enclosure, *enclosure.geometry, 0);
    }
    return true;
}

/// Sets the radiance of area lights anew. Returns false if the place or the shape of an area light
/// has changed, which takes a conversion of the whole graph.
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

/// Copies the changed materials and their textures into the scene.
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

void ScenePatcher::setBackground()
{
    const Vec4 background = backgroundOf(_convertedGraph.clearColor.value_or(_input.clearColor),
                                         !_scene->displayReferred);
    _changed |= background != _scene->background;
    _scene->background = background;
}

bool ScenePatcher::relight()
{
    ConversionReport report;
    setLights(*_scene, _input, _convertedGraph.lights, _caches, report);
    if (report.counts() != _convertedGraph.lightCounts)
        return refuse(ConversionCause::LightReport, {});
    _changed |= stampLights(_scene->lights, _last.lights, _now);
    _changed |= !sameAtmosphere(*_scene, _last);
    _changed |= stampVolumes(_scene->volumes, _last.volumes, _now);
    if (!anyShines(_last.lights) && !anyShines(_scene->lights)) return true;
    const std::size_t count = std::min(_last.instances.size(), _scene->instances.size());
    for (std::size_t i = 0; i < count; ++i)
        if (_scene->instances[i].light != _last.instances[i].light)
            _scene->instances[i].changed = _now;
    return true;
}

} // namespace osgRayTrace::engine
