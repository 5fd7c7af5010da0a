// SceneBuilder.cpp - makes meshes, instances and materials of what was collected. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/SceneBuilder.h"

#include "osgRayTrace/bridge/appearance/lights/LightConverter.h"
#include "osgRayTrace/bridge/appearance/materials/PhysicalConversion.h"
#include "osgRayTrace/bridge/appearance/materials/SurfaceState.h"
#include "osgRayTrace/bridge/convert/Background.h"
#include "osgRayTrace/bridge/convert/InstanceOrder.h"
#include "osgRayTrace/bridge/convert/SceneLights.h"
#include "osgRayTrace/bridge/geometry/BoundArrays.h"
#include "osgRayTrace/bridge/geometry/MeshPlacement.h"
#include "osgRayTrace/scene/Bodies.h"

#include <osgRayTrace/AreaLight>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Ambient lights above the scene: that of osgUtil::SceneView's light model, and OpenGL's, which
/// holds if osgViewer sets none.
constexpr float kViewerAmbient = 0.1f;
constexpr float kOpenGLAmbient = 0.2f;
constexpr uint32_t kOwnVariant = GeometryCache::kOwnVariant;

} // namespace

SceneBuilder::SceneBuilder(const ConversionInput& input, const CollectedGraph& graph,
                           const BuildRules& rules, ConversionCaches& caches,
                           ConvertedGraph& convertedGraph, Scene& scene, ConversionReport& report)
    : _input(input),
      _graph(graph),
      _rules(rules),
      _caches(caches),
      _convertedGraph(convertedGraph),
      _scene(scene),
      _report(report),
      _materials({rules.linear, input.cullAllRays, rules.setsColor}, caches.textures,
                 _materialReport),
      _effects(graph.states.size())
{
}

void SceneBuilder::build()
{
    _scene.origin = {_input.origin.x(), _input.origin.y(), _input.origin.z()};
    _scene.unit = _rules.unit;
    _scene.displayReferred = !_rules.linear;
    _scene.fogUse = _input.fogUse;
    _scene.background = backgroundOf(_graph.clearColor.value_or(_input.clearColor), _rules.linear);
    _scene.ambient = Vec3(_input.lighting ? kViewerAmbient : kOpenGLAmbient);
    recordNew();
    for (const CollectedGeometry& geometry : _graph.geometries)
    {
        _report.setPlace([&geometry] { return geometry.path; });
        addGeometry(geometry);
    }
    _report.setPlace({});
    _caches.areaLights.resize(_graph.lights.areaLights.size());
    for (std::size_t i = 0; i < _graph.lights.areaLights.size(); ++i)
        addAreaLight(_graph.lights.areaLights[i], _caches.areaLights[i]);
    _scene.materials = _convertedGraph.materials.all();
    if (_scene.materials.empty()) _scene.materials.push_back(fallbackMaterial());
    _caches.textures.end();
    _scene.textures = _caches.textures.all();
    putFlatFirst();
    recordStaticMeshes(_scene, _rules.comparable, _caches);
    _report.count("converted.instance", _scene.instances.size());
}

void SceneBuilder::add(const CollectedGeometry& geometry)
{
    _report.setPlace([&geometry] { return geometry.path; });
    const std::size_t before = _scene.instances.size() - _convertedGraph.instanceGaps.size();
    addGeometry(geometry);
    _report.count("converted.instance",
                  _scene.instances.size() - _convertedGraph.instanceGaps.size() - before);
    _report.setPlace({});
}

MeshRequest SceneBuilder::requestFor(const CollectedGeometry& geometry,
                                     const osg::Matrixd& transform) const
{
    MeshRequest request;
    request.restart = geometry.restart;
    request.pointRadius = geometry.pointRadius;
    if (!transform.isIdentity()) request.transform = transform;
    request.decodeColors = _rules.linear;
    if (geometry.geometry->getNumTexCoordArrays() > kFirstMoreUvs)
        for (const GeometryUse& use : geometry.uses)
            request.uvSets |= moreUvSetsOf(_graph.states[use.state]);
    return request;
}

uint32_t SceneBuilder::addMesh(const std::shared_ptr<const Mesh>& mesh)
{
    if (_convertedGraph.meshGaps.empty())
    {
        _scene.meshes.push_back(mesh);
        return static_cast<uint32_t>(_scene.meshes.size() - 1);
    }
    const uint32_t index = _convertedGraph.meshGaps.back();
    _convertedGraph.meshGaps.pop_back();
    _scene.meshes[index] = mesh;
    return index;
}

uint32_t SceneBuilder::appendInstance(const Instance& instance)
{
    if (_convertedGraph.instanceGaps.empty() || !instance.placed)
    {
        _scene.instances.push_back(instance);
        return static_cast<uint32_t>(_scene.instances.size() - 1);
    }
    const uint32_t index = _convertedGraph.instanceGaps.back();
    _convertedGraph.instanceGaps.pop_back();
    _scene.instances[index] = instance;
    return index;
}

/// Warns if the vertices of a geometry are coarse in float, an error made before the graph came.
void SceneBuilder::warnIfCoarse(const CollectedGeometry& geometry)
{
    if (!areCoarseInFloat(*geometry.bounds)) return;
    if (positionArray(*geometry.geometry)->getDataType() != GL_FLOAT) return;
    _report.warn("warned.far-vertices", "geometry '" + geometry.path + "'",
                 "vertices far from the geometry's own origin are coarse in float: use local "
                 "coordinates below a transform");
}

/// Warns if a geometry has an interior, but does not enclose it.
void SceneBuilder::warnIfOpen(const CollectedGeometry& geometry, const Instance& instance)
{
    const Material& material = _convertedGraph.materials[instance.material];
    if (!enclosesBody(material) || !material.detail || !material.detail->fillsBody()) return;
    if (_caches.closedMeshes.isClosed(*_scene.meshes[instance.mesh])) return;
    _report.warn("warned.open-body", "geometry '" + geometry.path + "'",
                 "the interior is not enclosed: rays that leave through a hole take it along");
}

/// Records whether new geometries join the static BVH. They get BVHs of their own, unless they have
/// so many vertices that the static BVH may as well be built again.
void SceneBuilder::recordNew()
{
    uint64_t vertices = 0;
    for (const CollectedGeometry& geometry : _graph.geometries)
        if (!_caches.geometries.lastRequest(*geometry.geometry)) vertices += geometry.bounds->count;
    _newJoinStatic = vertices >= _caches.staticVertices;
}

/// Returns whether a geometry is used more often than once or is not still: a geometry that has
/// moved or deformed since it came is expected to do so again, and one that a viewer may exchange
/// with all of its subtree to go.
bool SceneBuilder::isPlaced(const CollectedGeometry& collected)
{
    const osg::Geometry& geometry = *collected.geometry;
    GeometryCache& cache = _caches.geometries;
    const MeshRequest* last = cache.lastRequest(geometry);
    // A geometry that was collected twice may find the request of its other primitive restart.
    const bool own = last && last->restart == collected.restart;
    const bool once = collected.uses.size() == 1;
    if (_rules.comparable && last && !cache.hasSameArrays(geometry))
        cache.recordMobility(geometry, Mobility::Deforming);
    else if (_rules.comparable && once && own &&
             last->transform !=
                 requestFor(collected, collected.uses.front().engineFromLocal).transform)
        cache.recordMobility(geometry, Mobility::Dynamic);
    else if (once && (_rules.patches || _caches.noStaticBvh ||
                      (_rules.comparable && !last && !_newJoinStatic)))
        cache.recordMobility(geometry, Mobility::Dynamic);
    else if (once && _input.rasterizesRest && collected.uses.front().subtree != kNoSubtree &&
             collected.bounds->count >= kPlacedVertices)
        cache.recordMobility(geometry, Mobility::Dynamic);
    return !once || cache.mobility(geometry) != Mobility::Static;
}

void SceneBuilder::putFlatFirst()
{
    const std::vector<uint32_t> now = engine::putFlatFirst(_scene.instances);
    const auto renumber = [&now](uint32_t& index)
    {
        if (index != kInvalid) index = now[index];
    };
    for (auto& [geometry, traced] : _convertedGraph.index.geometries)
        for (TracedUse& use : traced.uses)
            renumber(use.instance);
    for (uint32_t& instance : _instances)
        renumber(instance);
    for (ConversionCaches::Quad& quad : _caches.areaLights)
        renumber(quad.instance);
    for (ClippedUse& use : _convertedGraph.clipped)
        renumber(use.instance);
}

/// Puts the planes that cross the geometry into the request, which is for engine space. Returns how
/// much of the geometry the planes clip.
Clipping SceneBuilder::clipBy(const CollectedGeometry& geometry, const GeometryUse& use,
                              MeshRequest& request)
{
    std::vector<Vec4d> planes = _graph.clipPlanes.planesOf(clipPlanesOn(_graph.states[use.state]));
    const Clipping clipping =
        clippingOf(*geometry.geometry, *geometry.bounds, use.engineFromLocal, planes);
    if (clipping == Clipping::Wholly) reportOf(geometry).count("not-traced.clipped-away");
    if (clipping == Clipping::Partly) request.clipPlanes = std::move(planes);
    return clipping;
}

/// Records a use for which planes are on, and which has just been added, for ScenePatcher.
void SceneBuilder::recordClipped(const CollectedGeometry& geometry, const GeometryUse& use,
                                 const MeshRequest& request, uint32_t variant, Clipping clipping,
                                 bool own)
{
    const uint64_t numbers = clipPlanesOn(_graph.states[use.state]);
    if (numbers == 0) return;
    _convertedGraph.clipped.push_back({geometry.geometry, use.engineFromLocal, numbers, request,
                                       variant, clipping, own, _instances.back()});
}

/// Adds a geometry. A still geometry that is used once gets positions in engine space, which are
/// made in double; a geometry that is used more often gets one mesh and several instances.
void SceneBuilder::addGeometry(const CollectedGeometry& geometry)
{
    std::unique_ptr<ConversionCounts> remarks;
    _report.setListener(
        [&remarks](const std::string& what, uint64_t number)
        {
            if (what.rfind("converted.", 0) == 0) return;
            if (!remarks) remarks = std::make_unique<ConversionCounts>();
            (*remarks)[what] += number;
        });
    warnIfCoarse(geometry);
    TracedGeometry& traced = _convertedGraph.index.at(*geometry.geometry);
    // The index holds only one of a geometry that was collected for two primitive restarts.
    traced.culled = traced.uses.empty() && geometry.isCulled();
    traced.patchable = traced.culled || (traced.uses.empty() && geometry.watched);
    _convertedGraph.index.removeUses(traced);
    traced.uses.reserve(geometry.uses.size());
    bool raised = false;
    for (const GeometryUse& use : geometry.uses)
    {
        raised |= depthBias(_graph.states[use.state]) != 0.0f;
        traced.patchable &= clipPlanesOn(_graph.states[use.state]) == 0;
    }
    traced.raised = raised && geometry.uses.size() == 1;
    traced.patchable &= raised == traced.raised;
    if (isPlaced(geometry) && !traced.raised)
        addPlacedUses(geometry);
    else
    {
        const GeometryUse& use = geometry.uses.front();
        MeshRequest request = requestFor(geometry, use.engineFromLocal);
        request.depthBias = depthBias(_graph.states[use.state]);
        const Clipping clipping = clipBy(geometry, use, request);
        if (clipping == Clipping::Wholly)
            addNothing(geometry, use);
        else
            addBaked(geometry, use,
                     _caches.geometries.mesh(*geometry.geometry, kOwnVariant, request,
                                             geometry.path, reportOf(geometry)));
        recordClipped(geometry, use, request, kOwnVariant, clipping, true);
    }
    _report.setListener({});
    traced.plain = !remarks;
    traced.remarks = std::move(remarks);
}

void SceneBuilder::addBaked(const CollectedGeometry& geometry, const GeometryUse& use,
                            const std::shared_ptr<const Mesh>& mesh)
{
    if (!mesh)
    {
        addNothing(geometry, use);
        return;
    }
    reportOf(geometry).count("converted.geometry");
    Instance instance;
    instance.mesh = addMesh(mesh);
    // The static BVH must not be built time and again, and nothing keeps it once it is given up.
    if (_rules.patches || _caches.noStaticBvh ||
        (clipPlanesOn(_graph.states[use.state]) & _caches.movedPlanes) ||
        _caches.geometries.mobility(*geometry.geometry) != Mobility::Static)
        placeInstance(instance, osg::Matrixd());
    addInstance(geometry, use, instance);
}

void SceneBuilder::addPlacedUses(const CollectedGeometry& geometry)
{
    const MeshFrame frame = meshFrame(*geometry.bounds);
    MeshRequest request = requestFor(geometry, frame.meshFromLocal);
    request.copies = _caches.geometries.mobility(*geometry.geometry) == Mobility::Deforming;
    ConversionReport& report = reportOf(geometry);
    const auto mesh =
        _caches.geometries.mesh(*geometry.geometry, kOwnVariant, request, geometry.path, report);
    if (!mesh)
    {
        for (const GeometryUse& use : geometry.uses)
            addNothing(geometry, use);
        return;
    }
    uint32_t variant = kOwnVariant, meshIndex = kInvalid; // the mesh enters with its first instance
    for (const GeometryUse& use : geometry.uses)
    {
        ++variant;
        MeshRequest own = requestFor(geometry, use.engineFromLocal);
        own.depthBias = depthBias(_graph.states[use.state]);
        const Clipping clipping = clipBy(geometry, use, own);
        if (clipping == Clipping::Wholly)
        {
            addNothing(geometry, use);
            recordClipped(geometry, use, own, variant, clipping, true);
            continue;
        }
        Instance instance;
        if (clipping != Clipping::None || own.depthBias != 0.0f ||
            !placeInstance(instance, frame.localFromMesh * use.engineFromLocal))
        {
            _convertedGraph.index.at(*geometry.geometry).patchable =
                false; // the shared mesh does not hold this use
            addBaked(
                geometry, use,
                _caches.geometries.mesh(*geometry.geometry, variant, own, geometry.path, report));
            recordClipped(geometry, use, own, variant, clipping, true);
            continue;
        }
        if (meshIndex == kInvalid)
        {
            report.count("converted.geometry");
            meshIndex = addMesh(mesh);
        }
        instance.mesh = meshIndex;
        addInstance(geometry, use, instance);
        recordClipped(geometry, use, own, variant, clipping, false);
    }
}

bool SceneBuilder::addUse(const CollectedGeometry& geometry, const GeometryUse& use,
                          uint32_t before)
{
    TracedGeometry& traced = _convertedGraph.index.at(*geometry.geometry);
    const MeshRequest* request = _caches.geometries.lastRequest(*geometry.geometry);
    if (!request || traced.uses.empty() || traced.raised ||
        depthBias(_graph.states[use.state]) != 0.0f)
        return false;
    if (moreUvSetsOf(_graph.states[use.state]) & ~request->uvSets) return false;
    osg::Matrixd localFromMesh;
    if (request->transform) localFromMesh = osg::Matrixd::inverse(*request->transform);
    const uint32_t other = traced.uses.front().instance;
    if (other == kInvalid || !_scene.instances[other].placed) return false;
    Instance instance;
    instance.mesh = _scene.instances[other].mesh;
    if (!placeInstance(instance, localFromMesh * use.engineFromLocal)) return false;
    TracedUse result = newInstance(geometry, use, instance);
    result.subtree = subtreeOf(use);
    _convertedGraph.index.addUse(traced, result, before);
    _report.count("converted.instance");
    return true;
}

void SceneBuilder::addInstance(const CollectedGeometry& geometry, const GeometryUse& use,
                               Instance instance)
{
    recordUse(geometry, use, newInstance(geometry, use, instance));
}

void SceneBuilder::recordUse(const CollectedGeometry& geometry, const GeometryUse& use,
                             TracedUse traced)
{
    traced.subtree = subtreeOf(use);
    TracedGeometry& all = _convertedGraph.index.at(*geometry.geometry);
    _convertedGraph.index.addUse(all, traced, all.uses.size());
    _instances.push_back(traced.instance);
}

TracedUse SceneBuilder::newInstance(const CollectedGeometry& geometry, const GeometryUse& use,
                                    Instance instance)
{
    if (use.proxy) return newProxy(geometry, use, instance);
    const GraphState& state = _graph.states[use.state];
    _materialReport = ConversionReport();
    instance.material = _convertedGraph.materials.add(
        materialOf(_materials, use, _graph, surfaceInputs(*geometry.geometry, _input.pointRadius)));
    _report.addHere(_materialReport);
    warnIfOpen(geometry, instance);
    setAmbient(state);
    instance.changed = _rules.now;
    return {appendInstance(instance), effects(use.state, _materialReport.counts())};
}

uint32_t SceneBuilder::effects(uint32_t state, const ConversionCounts& counts)
{
    std::optional<StateEffects>& known = _effects[state];
    if (!known) known = stateEffectsOf(_graph.states[state], _caches.textures);
    StateEffects wanted = *known;
    wanted.counts = counts;
    return _convertedGraph.index.effects(wanted);
}

/// Sets the scene's one ambient light from the first light model; OpenGL has one a drawable.
void SceneBuilder::setAmbient(const GraphState& state)
{
    const auto* model = state.attribute<osg::LightModel>(kLightModelSlot);
    if (!model || model == _lightModel || !state.isOn(kLightingBit)) return;
    const osg::Vec4& color = model->getAmbientIntensity();
    const Vec3 ambient(color.r(), color.g(), color.b());
    if (_lightModel && ambient != _scene.ambient)
    {
        _report.count("approximated.light-model");
        return;
    }
    _lightModel = model;
    if (isFinite(ambient)) _scene.ambient = ambient;
}

/// Adds an area light. quad is the light's quad of the last snapshot, if there is one, and its mesh
/// stays if the light has not moved.
void SceneBuilder::addAreaLight(const CollectedAreaLight& source, ConversionCaches::Quad& quad)
{
    auto converted = convertAreaLight(*source.light, source.engineFromLocal);
    quad.instance = kInvalid;
    if (!converted)
    {
        _report.warn("skipped.area-light", "area light '" + source.path + "'",
                     "no area, not finite or above 1e18, skipped");
        return;
    }
    _report.count("converted.area-light");
    quad.light = converted->light;
    if (!quad.mesh || !std::equal(quad.mesh->positions.begin(), quad.mesh->positions.end(),
                                  converted->mesh->positions.begin()))
    {
        converted->mesh->name = source.path;
        converted->mesh->changed = _rules.now;
        quad.dynamic |= _rules.comparable;
        quad.mesh = converted->mesh;
    }
    Instance instance;
    instance.material = _convertedGraph.materials.add(lampMaterial(quad.light.radiance));
    instance.mesh = addMesh(quad.mesh);
    if (quad.dynamic || _caches.noStaticBvh) placeInstance(instance, osg::Matrixd());
    quad.instance = appendInstance(instance);
}

} // namespace osgRayTrace::engine
