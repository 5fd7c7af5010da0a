// SceneConverter.cpp - puts a Scene together from what the visitor collected. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/SceneConverter.h"

#include "osgRayTrace/bridge/EnvironmentConverter.h"
#include "osgRayTrace/bridge/GeometryCache.h"
#include "osgRayTrace/bridge/GraphCollector.h"
#include "osgRayTrace/bridge/LightConverter.h"
#include "osgRayTrace/bridge/MaterialConverter.h"
#include "osgRayTrace/bridge/MeshPlacement.h"
#include "osgRayTrace/bridge/SceneExtent.h"
#include "osgRayTrace/bridge/ScenePatcher.h"
#include "osgRayTrace/bridge/SnapshotStamps.h"
#include "osgRayTrace/bridge/TextureConverter.h"
#include "osgRayTrace/bridge/VertexArrays.h"
#include "osgRayTrace/film/ToneMap.h"

#include <osgRayTrace/AreaLight>

#include <osg/LightModel>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

namespace osgRayTrace::engine
{

namespace
{

/// Above the scene: osgUtil::SceneView's light model, or OpenGL's where osgViewer sets none.
constexpr float kViewerAmbient = 0.1f;
constexpr float kOpenGLAmbient = 0.2f;

constexpr uint32_t kOwnVariant = GeometryCache::kOwnVariant;

/// Vertices of the flat BVH: fewer are built again in no time.
constexpr uint64_t kSmallFlat = 32768;

/// Builds of a larger one for the sake of what leaves it; then all meshes get BVHs of their own.
constexpr int kMostFlatBuilds = 3;

void setBounds(CollectedGraph& graph, GeometryCache& geometries)
{
    for (CollectedGeometry& geometry : graph.geometries)
        geometry.bounds = &geometries.bounds(*geometry.geometry);
}

/// Of all that is traced, where the lengths of the graph are those of the world.
LengthCounts lengthsOf(const CollectedGraph& graph)
{
    LengthCounts lengths;
    for (const CollectedGeometry& geometry : graph.geometries)
    {
        const VertexBounds& bounds = *geometry.bounds;
        if (bounds.count == 0) continue;
        for (const GeometryUse& use : geometry.uses)
            lengths.add(largestCoordinate(bounds, use.engineFromLocal), bounds.count);
    }
    for (const CollectedAreaLight& source : graph.areaLights)
    {
        const AreaLight& light = *source.light;
        for (const osg::Vec3d& p :
             {osg::Vec3d(), osg::Vec3d(light.getEdgeU()), osg::Vec3d(light.getEdgeV())})
        {
            const osg::Vec3d q = (osg::Vec3d(light.getCorner()) + p) * source.engineFromLocal;
            lengths.add(std::max({std::fabs(q.x()), std::fabs(q.y()), std::fabs(q.z())}));
        }
    }
    return lengths;
}

bool isLinear(const CollectedGraph& graph, RayTraceSettings::ColorRule rule)
{
    if (rule != RayTraceSettings::AUTOMATIC_COLOR) return rule == RayTraceSettings::LINEAR;
    if (!graph.areaLights.empty() || !graph.environments.empty()) return true;
    for (const CollectedGeometry& geometry : graph.geometries)
        for (const GeometryUse& use : geometry.uses)
            if (graph.states[use.state].attributes[kPhysicalMaterialSlot]) return true;
    return false;
}

Vec4 backgroundOf(const osg::Vec4& clearColor, bool linear)
{
    Vec4 color(clearColor.r(), clearColor.g(), clearColor.b(), clearColor.a());
    for (int c = 0; c < 4; ++c)
        if (!std::isfinite(color[c])) color[c] = 0.0f;
    for (int c = 0; c < 3 && linear; ++c)
        color[c] = linearFromSrgb(color[c]);
    return color;
}

/// A visible one, for a scene without any.
Material fallbackMaterial()
{
    Material material;
    material.name = "fallback";
    material.ambient = material.diffuse = Vec3(1.0f, 0.0f, 1.0f);
    material.lit = false;
    return material;
}

/// What is kept between snapshots.
struct ConversionCaches
{
    SoftwareVertices vertices;
    GeometryCache geometries;
    TextureConverter textures;
    EnvironmentConverter environment;
    struct Quad
    {
        std::shared_ptr<const Mesh> mesh;
        bool moves = false; ///< has moved: it is in no flat BVH
    };
    std::vector<Quad> areaLights; ///< in the order of the traversal
    std::vector<const Mesh*> flat; ///< all meshes that are not placed; names, not followed
    uint64_t flatVertices = 0;
    int flatBuilds = 0;     ///< of a large flat BVH that something has left
    bool dissolved = false; ///< there is no flat BVH any more
};

/// If a large flat BVH must be built time and again, there shall be none.
void noteFlat(const Scene& scene, bool comparable, ConversionCaches& caches)
{
    std::vector<const Mesh*> flat;
    uint64_t vertices = 0;
    for (const Instance& instance : scene.instances)
    {
        if (instance.placed) continue;
        flat.push_back(scene.meshes[instance.mesh].get());
        vertices += flat.back()->positions.size();
    }
    const bool large = caches.flatVertices > kSmallFlat;
    if (comparable && large && flat != caches.flat &&
        ++caches.flatBuilds >= kMostFlatBuilds)
        caches.dissolved = true;
    caches.flat = std::move(flat);
    caches.flatVertices = vertices;
}

/// Adds the parts of one snapshot to its Scene.
class SceneBuilder
{
public:
    SceneBuilder(const ConversionInput& input, const CollectedGraph& graph, double unit,
                 bool linear, bool comparable, Stamp now, ConversionCaches& caches,
                 ConversionReport& report)
        : _input(input),
          _graph(graph),
          _unit(unit),
          _linear(linear),
          _comparable(comparable),
          _now(now),
          _caches(caches),
          _report(report),
          _materials({linear, input.cullAllRays}, caches.textures, report),
          _scene(std::make_shared<Scene>())
    {
    }

    std::shared_ptr<Scene> build()
    {
        _scene->origin = {_input.origin.x(), _input.origin.y(), _input.origin.z()};
        _scene->unit = _unit;
        _scene->displayReferred = !_linear;
        _scene->background = backgroundOf(_input.clearColor, _linear);
        _scene->ambient = Vec3(_input.lighting ? kViewerAmbient : kOpenGLAmbient);
        noteNew();
        for (const CollectedGeometry& geometry : _graph.geometries)
        {
            _report.setPlace([&geometry] { return geometry.path; });
            addGeometry(geometry);
        }
        _report.setPlace({});
        _caches.areaLights.resize(_graph.areaLights.size());
        for (std::size_t i = 0; i < _graph.areaLights.size(); ++i)
            addAreaLight(_graph.areaLights[i], _caches.areaLights[i]);
        _scene->materials = _materials.take();
        _scene->textures = _caches.textures.end();
        putFlatFirst();
        noteFlat(*_scene, _comparable, _caches);
        addLights();
        addEnvironment();
        if (_scene->materials.empty()) _scene->materials.push_back(fallbackMaterial());
        _report.count("converted.instance", _scene->instances.size());
        _report.count("converted.light", _scene->lights.size());
        return std::move(_scene);
    }

    SceneIndex takeIndex() { return std::move(_index); }

private:
    void noteNew();
    bool isPlaced(const CollectedGeometry& geometry);
    void putFlatFirst();
    void addGeometry(const CollectedGeometry& geometry);
    void warnIfCoarse(const CollectedGeometry& geometry);
    Clipping clipBy(const CollectedGeometry& geometry, const GeometryUse& use,
                    MeshRequest& request);
    void addPlacedUses(const CollectedGeometry& geometry);
    void addBaked(const CollectedGeometry& geometry, const GeometryUse& use,
                  const std::shared_ptr<const Mesh>& mesh);
    void addInstance(const CollectedGeometry& geometry, const GeometryUse& use, Instance instance);
    void addAreaLight(const CollectedAreaLight& source, ConversionCaches::Quad& quad);
    void addLights();
    void addEnvironment();
    void setAmbient(const GraphState& state);
    uint32_t addMesh(const std::shared_ptr<const Mesh>& mesh);
    MeshRequest requestFor(const CollectedGeometry& geometry, const osg::Matrixd& transform) const;

    const ConversionInput& _input;
    const CollectedGraph& _graph;
    double _unit;
    bool _linear;
    bool _comparable; ///< with the last snapshot: what differs has changed
    bool _newJoinFlat = true;
    Stamp _now;
    ConversionCaches& _caches;
    ConversionReport& _report;
    MaterialConverter _materials;
    std::shared_ptr<Scene> _scene;
    SceneIndex _index;
    const osg::LightModel* _lightModel = nullptr; // the first one met
};

MeshRequest SceneBuilder::requestFor(const CollectedGeometry& geometry,
                                     const osg::Matrixd& transform) const
{
    MeshRequest request;
    request.restart = geometry.restart;
    if (!transform.isIdentity()) request.transform = transform;
    request.decodeColors = _linear;
    return request;
}

uint32_t SceneBuilder::addMesh(const std::shared_ptr<const Mesh>& mesh)
{
    _scene->meshes.push_back(mesh);
    return static_cast<uint32_t>(_scene->meshes.size() - 1);
}

/// The error was made before the graph came here: it can only be named.
void SceneBuilder::warnIfCoarse(const CollectedGeometry& geometry)
{
    if (!areCoarseInFloat(*geometry.bounds)) return;
    if (positionArray(*geometry.geometry)->getDataType() != GL_FLOAT) return;
    _report.warn("warned.far-vertices", "geometry '" + geometry.path + "'",
                 "vertices far from the geometry's own origin are coarse in float: use local "
                 "coordinates below a transform");
}

/// What comes into a scene gets BVHs of its own, unless it is so much that the flat one may as well be
/// built again.
void SceneBuilder::noteNew()
{
    uint64_t vertices = 0;
    for (const CollectedGeometry& geometry : _graph.geometries)
        if (!_caches.geometries.lastRequest(*geometry.geometry)) vertices += geometry.bounds->count;
    _newJoinFlat = vertices >= _caches.flatVertices;
}

/// Used more often than once, or not still: what has moved or deformed since it came will do so again.
bool SceneBuilder::isPlaced(const CollectedGeometry& collected)
{
    const osg::Geometry& geometry = *collected.geometry;
    GeometryCache& cache = _caches.geometries;
    const MeshRequest* last = cache.lastRequest(geometry);
    const bool once = collected.uses.size() == 1;
    if (_comparable && last && !cache.hasSameArrays(geometry))
        cache.noteLiveness(geometry, Liveness::Deforms);
    else if (_comparable && once && last &&
             last->transform != requestFor(collected, collected.uses.front().engineFromLocal).transform)
        cache.noteLiveness(geometry, Liveness::Moves);
    else if (once && (_caches.dissolved || (_comparable && !last && !_newJoinFlat)))
        cache.noteLiveness(geometry, Liveness::Moves);
    return !once || cache.liveness(geometry) != Liveness::Still;
}

/// Their indices are then a matter of themselves alone, and so is their BVH.
void SceneBuilder::putFlatFirst()
{
    std::vector<Instance>& instances = _scene->instances;
    std::vector<uint32_t> order(instances.size()), now(instances.size());
    for (uint32_t i = 0; i < order.size(); ++i)
        order[i] = i;
    std::stable_partition(order.begin(), order.end(),
                          [&](uint32_t i) { return !instances[i].placed; });
    std::vector<Instance> sorted;
    sorted.reserve(instances.size());
    for (uint32_t i = 0; i < order.size(); ++i)
    {
        sorted.push_back(instances[order[i]]);
        now[order[i]] = i;
    }
    instances.swap(sorted);
    for (Light& light : _scene->lights)
        if (light.instance != kInvalid) light.instance = now[light.instance];
    for (uint32_t& index : _index.instances)
        if (index != kInvalid) index = now[index];
}

/// Puts the planes that cross the geometry into the request, which is for engine space.
Clipping SceneBuilder::clipBy(const CollectedGeometry& geometry, const GeometryUse& use,
                              MeshRequest& request)
{
    std::vector<Vec4d> planes = _graph.clipPlanes.planesOn(_graph.states[use.state]);
    if (planes.empty()) return Clipping::None;
    const osg::Array* positions = positionArray(*geometry.geometry);
    const bool bounded = positions && geometry.bounds->count == positions->getNumElements();
    const Clipping clipping =
        bounded ? clippingOf(*geometry.bounds, use.engineFromLocal, planes) : Clipping::Partly;
    if (clipping == Clipping::Wholly) _report.count("not-traced.clipped-away");
    if (clipping == Clipping::Partly) request.clipPlanes = std::move(planes);
    return clipping;
}

/// Used once: positions in engine space, made in double. Used more often: one mesh, several
/// instances.
void SceneBuilder::addGeometry(const CollectedGeometry& geometry)
{
    warnIfCoarse(geometry);
    const auto first = static_cast<uint32_t>(_index.instances.size());
    // One that is here twice has other primitive restart: only one of both is in the index.
    const bool once = _index.uses.count(geometry.geometry) == 0;
    const bool lifted = std::any_of(geometry.uses.begin(), geometry.uses.end(),
                                    [this](const GeometryUse& use)
                                    { return polygonLift(_graph.states[use.state]) != 0.0f; });
    _index.uses[geometry.geometry] = {first, static_cast<uint32_t>(geometry.uses.size()),
                                      once && !lifted};
    if (isPlaced(geometry))
    {
        addPlacedUses(geometry);
        return;
    }
    const GeometryUse& use = geometry.uses.front();
    MeshRequest request = requestFor(geometry, use.engineFromLocal);
    request.lift = polygonLift(_graph.states[use.state]);
    if (clipBy(geometry, use, request) == Clipping::Wholly)
    {
        _index.instances.push_back(kInvalid);
        return;
    }
    addBaked(
        geometry, use,
        _caches.geometries.mesh(*geometry.geometry, kOwnVariant, request, geometry.path, _report));
}

void SceneBuilder::addBaked(const CollectedGeometry& geometry, const GeometryUse& use,
                            const std::shared_ptr<const Mesh>& mesh)
{
    if (!mesh)
    {
        _index.instances.push_back(kInvalid);
        return;
    }
    _report.count("converted.geometry");
    Instance instance;
    instance.mesh = addMesh(mesh);
    addInstance(geometry, use, instance);
}

void SceneBuilder::addPlacedUses(const CollectedGeometry& geometry)
{
    const MeshFrame frame = meshFrame(*geometry.bounds);
    MeshRequest request = requestFor(geometry, frame.meshFromLocal);
    request.copies = _caches.geometries.liveness(*geometry.geometry) == Liveness::Deforms;
    const auto mesh =
        _caches.geometries.mesh(*geometry.geometry, kOwnVariant, request, geometry.path, _report);
    if (!mesh)
    {
        _index.instances.resize(_index.instances.size() + geometry.uses.size(), kInvalid);
        return;
    }
    _report.count("converted.geometry");
    const uint32_t meshIndex = addMesh(mesh);
    uint32_t variant = kOwnVariant;
    for (const GeometryUse& use : geometry.uses)
    {
        ++variant;
        MeshRequest own = requestFor(geometry, use.engineFromLocal);
        own.lift = polygonLift(_graph.states[use.state]);
        const Clipping clipping = clipBy(geometry, use, own);
        if (clipping == Clipping::Wholly)
        {
            _index.instances.push_back(kInvalid);
            continue;
        }
        Instance instance;
        instance.mesh = meshIndex;
        if (clipping == Clipping::None && own.lift == 0.0f &&
            placeInstance(instance, frame.localFromMesh * use.engineFromLocal))
            addInstance(geometry, use, instance);
        else
            addBaked(geometry, use,
                     _caches.geometries.mesh(*geometry.geometry, variant, own, geometry.path,
                                             _report));
    }
}

void SceneBuilder::addInstance(const CollectedGeometry& geometry, const GeometryUse& use,
                               Instance instance)
{
    const GraphState& state = _graph.states[use.state];
    instance.material = _materials.index(state, surfaceInputs(*geometry.geometry),
                                         {use.engineFromLocal, &_graph.texGens});
    setAmbient(state);
    const Material& material = _materials.at(instance.material);
    const auto index = static_cast<uint32_t>(_scene->instances.size());
    if (material.model == MaterialModel::Physical && material.emission != Vec3(0.0f))
    {
        instance.light = static_cast<uint32_t>(_scene->lights.size());
        _scene->lights.push_back(meshLight(geometry.path, material.emission, index));
    }
    _index.instances.push_back(index);
    _scene->instances.push_back(instance);
}

/// One light model for all: OpenGL has one for each drawable, but scenes do not.
void SceneBuilder::setAmbient(const GraphState& state)
{
    const auto* model = state.attribute<osg::LightModel>(kLightModelSlot);
    if (!model || model == _lightModel || !state.isOn(kLightingBit)) return;
    const osg::Vec4& color = model->getAmbientIntensity();
    const Vec3 ambient(color.r(), color.g(), color.b());
    if (_lightModel && ambient != _scene->ambient)
    {
        _report.count("approximated.light-model");
        return;
    }
    _lightModel = model;
    if (isFinite(ambient)) _scene->ambient = ambient;
}

/// quad is that of the last snapshot, if any, and stays if the light has not moved.
void SceneBuilder::addAreaLight(const CollectedAreaLight& source, ConversionCaches::Quad& quad)
{
    auto converted = convertAreaLight(*source.light, source.engineFromLocal);
    if (!converted)
    {
        _report.warn("skipped.area-light", "area light '" + source.path + "'",
                     "no area, not finite or above 1e18, skipped");
        return;
    }
    _report.count("converted.area-light");
    Instance instance;
    instance.material = _materials.lampIndex(converted->light.radiance);
    if (!quad.mesh || !std::equal(quad.mesh->positions.begin(), quad.mesh->positions.end(),
                                  converted->mesh->positions.begin()))
    {
        converted->mesh->name = source.path;
        converted->mesh->changed = _now;
        quad.moves |= _comparable;
        quad.mesh = converted->mesh;
    }
    instance.mesh = addMesh(quad.mesh);
    if (quad.moves || _caches.dissolved) placeInstance(instance, osg::Matrixd());
    if (converted->light.radiance != Vec3(0.0f))
    {
        instance.light = static_cast<uint32_t>(_scene->lights.size());
        converted->light.instance = static_cast<uint32_t>(_scene->instances.size());
        _scene->lights.push_back(converted->light);
    }
    _scene->instances.push_back(instance);
}

/// As OpenGL keeps lights: by number, the last one set stays, and a light that no surface has
/// enabled does nothing. The viewer's light is set before those of the graph.
void SceneBuilder::addLights()
{
    std::map<int, Light> lights;
    std::map<std::string, float> unused = _input.lightSizes.byName;
    const auto add = [&](const osg::Light& source, const osg::Matrixd& matrix, bool eyeSpace,
                         const std::string& path)
    {
        const int number = source.getLightNum();
        auto light = convertLight(source, matrix, eyeSpace, _unit);
        if (!light || number < 0 || number >= 32)
        {
            _report.warn("skipped.light", "light '" + path + "'",
                         light ? "number is not 0 to 31, skipped"
                               : "values are not finite, skipped");
            return;
        }
        const std::string sizedAs = applyLightSize(_input.lightSizes, path, _unit, *light);
        if (!sizedAs.empty()) unused.erase(sizedAs);
        lights[number] = *light;
        if (lights[number].name.empty()) lights[number].name = path;
    };
    const osg::Matrixd engineFromWorld =
        osg::Matrixd::translate(-_input.origin) *
        osg::Matrixd::scale(1.0 / _unit, 1.0 / _unit, 1.0 / _unit);
    if (_input.viewLight)
        add(*_input.viewLight, _input.viewLightInEyeSpace ? osg::Matrixd() : engineFromWorld,
            _input.viewLightInEyeSpace, "viewer");
    for (const CollectedLight& light : _graph.lights)
        add(*light.light, light.engineFromLocal, light.eyeSpace, light.path);

    for (const auto& [name, size] : unused)
        _report.warn("warned.light-size", "light-sizes '" + name + "'", "there is no light of this name");

    uint32_t enabled = 0;
    for (const Material& material : _scene->materials)
        if (material.lit) enabled |= material.lightMask;
    for (const auto& [number, light] : lights)
        if (enabled >> number & 1u) _scene->lights.push_back(light);
}

/// There is one sky: the first that can be converted.
void SceneBuilder::addEnvironment()
{
    bool found = false;
    for (const CollectedEnvironment& source : _graph.environments)
    {
        if (found)
        {
            _report.warn("skipped.environment-light", "environment light '" + source.path + "'",
                         "the scene has one before it, skipped");
            continue;
        }
        const auto light = _caches.environment.convert(*source.light, source.engineFromLocal, _linear,
                                                       source.path, _report);
        found = light.has_value();
        if (found) _scene->lights.push_back(*light);
    }
}

/// Geometry that OpenGL draws is where its path puts it: it may move without a conversion.
void addUntraced(const RasterizedParts& parts, SceneIndex& index)
{
    const auto traced = static_cast<uint32_t>(index.instances.size());
    for (const RasterizedPart& part : parts)
    {
        const osg::Geometry* geometry = part.path.empty() ? nullptr : part.path.back()->asGeometry();
        if (!geometry || part.kind != RasterizedPart::Draw) continue;
        const auto [found, isNew] = index.uses.try_emplace(geometry);
        if (!isNew && found->second.first < traced) continue;
        if (isNew) found->second.first = static_cast<uint32_t>(index.instances.size());
        ++found->second.count;
        index.instances.push_back(kInvalid);
    }
}

} // namespace

struct SceneConverter::Implementation
{
    ConversionCaches caches;
    std::shared_ptr<const Scene> last;
    ConversionResult lastResult;
    SceneIndex index;
    bool ordinary = false; ///< unit is 1, and stays so as long as lengths are ordinary
    Stamp stamp = 0;
};

SceneConverter::SceneConverter() : _implementation(std::make_unique<Implementation>()) {}

SceneConverter::~SceneConverter() = default;

void SceneConverter::forget()
{
    _implementation->caches = ConversionCaches();
}

uint64_t SceneConverter::convertedMeshes() const
{
    return _implementation->caches.geometries.converted();
}

ConversionResult SceneConverter::convert(const ConversionInput& input)
{
    const auto begin = std::chrono::steady_clock::now();
    Implementation& state = *_implementation;
    const Stamp now = ++state.stamp;

    ConversionReport report;
    state.caches.vertices.begin();
    GraphCollector collector(input, state.caches.vertices, report);
    if (input.root) input.root->accept(collector);
    CollectedGraph graph = collector.take();

    const bool linear = isLinear(graph, input.colorRule);
    state.caches.geometries.begin(now);
    setBounds(graph, state.caches.geometries);
    const LengthCounts lengths = lengthsOf(graph);
    const double unit = lengths.unit();
    applyUnit(unit, graph);
    state.caches.textures.begin(linear, now);
    const Vec3d origin(input.origin.x(), input.origin.y(), input.origin.z());
    const bool comparable = state.last && !state.last->instances.empty() &&
                            state.last->origin == origin && state.last->unit == unit &&
                            state.last->displayReferred == !linear;
    SceneBuilder builder(input, graph, unit, linear, comparable, now, state.caches, report);
    state.last = stampChanges(builder.build(), state.last, now);
    state.caches.geometries.end();
    // Where planes clip depends on where a geometry is.
    constexpr uint64_t kAllPlanes = ((uint64_t(1) << kClipPlanes) - 1) << kClipPlaneBit;
    const bool clips = std::any_of(graph.states.begin(), graph.states.end(), [](const GraphState& s)
                                   { return (s.modesOn & kAllPlanes) != 0; });
    state.ordinary = unit == 1.0 && lengths.areOrdinary() && !clips;
    state.index = builder.takeIndex();
    state.caches.vertices.end();

    ConversionResult result;
    result.scene = state.last;
    result.paged = graph.paged;
    result.counts = report.counts();
    result.paths = report.paths();
    warnOnceAReason(report, input.rasterizesRest);
    addUntraced(graph.rasterized, state.index);
    const auto draws = [](const RasterizedPart& part) { return part.kind == RasterizedPart::Draw; };
    if (std::any_of(graph.rasterized.begin(), graph.rasterized.end(), draws))
        result.rasterized = std::make_shared<RasterizedParts>(std::move(graph.rasterized));
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    state.lastResult = result;
    return result;
}

std::optional<ConversionResult> SceneConverter::patch(const GraphChanges& changes)
{
    const auto begin = std::chrono::steady_clock::now();
    Implementation& state = *_implementation;
    if (!state.last || !state.ordinary || (state.caches.dissolved && !state.caches.flat.empty()))
        return std::nullopt;
    const Stamp now = ++state.stamp;
    ScenePatcher patcher(*state.last, state.index, state.caches.geometries, now);
    const std::shared_ptr<const Scene> scene = patcher.patch(changes);
    if (!scene) return std::nullopt;
    if (patcher.changed()) state.last = scene;
    if (patcher.leftFlat()) noteFlat(*scene, true, state.caches);
    if (state.caches.dissolved && !state.caches.flat.empty()) return std::nullopt;
    state.lastResult.scene = state.last;
    state.lastResult.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return state.lastResult;
}

} // namespace osgRayTrace::engine
