// SceneConverter.cpp - puts a Scene together from what the visitor collected. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/SceneConverter.h"

#include "osgRayTrace/bridge/GeometryCache.h"
#include "osgRayTrace/bridge/GraphCollector.h"
#include "osgRayTrace/bridge/LightConverter.h"
#include "osgRayTrace/bridge/MaterialConverter.h"
#include "osgRayTrace/bridge/SceneExtent.h"
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

/// Of GeometryCache: the mesh that all uses share. The use number n that cannot is n + 1.
constexpr uint32_t kOwnVariant = 0;

Affine toAffine(const osg::Matrixd& m)
{
    Affine affine;
    affine.linear = Mat3(Vec3(m(0, 0), m(0, 1), m(0, 2)), Vec3(m(1, 0), m(1, 1), m(1, 2)),
                         Vec3(m(2, 0), m(2, 1), m(2, 2)));
    affine.translation = Vec3(m(3, 0), m(3, 1), m(3, 2));
    return affine;
}

/// Whether Embree can invert the transform in float (see TracedScene); else the mesh is baked.
bool isPlaceable(const Affine& affine)
{
    constexpr float kSmallest = 1e-8f, kLargest = 1e8f;
    if (!isFinite(affine.translation)) return false;
    for (int column = 0; column < 3; ++column)
    {
        const float length = glm::length(affine.linear[column]);
        if (!(length >= kSmallest && length <= kLargest)) return false;
    }
    return std::fabs(glm::determinant(glm::dmat3(affine.linear))) > 1e-28;
}

/// Local coordinates are moved to their centre if that is so many radii away: else an instance
/// would lose in float what its large coordinates lose.
constexpr double kFarFromOrigin = 64.0;

/// Of a shared geometry: its mesh has its own origin and unit where those of the geometry would lose
/// in float.
struct MeshFrame
{
    osg::Matrixd meshFromLocal, localFromMesh;
};

MeshFrame meshFrame(const VertexBounds& bounds)
{
    MeshFrame frame;
    if (bounds.count == 0) return frame;
    const osg::Vec3d centre(bounds.centre().x, bounds.centre().y, bounds.centre().z);
    if (centre.length() > kFarFromOrigin * bounds.radius())
    {
        frame.meshFromLocal.makeTranslate(-centre);
        frame.localFromMesh.makeTranslate(centre);
    }
    LengthCounts lengths;
    lengths.add(largestCoordinate(bounds, frame.meshFromLocal));
    const double unit = lengths.unit(), inverse = 1.0 / unit;
    if (unit == 1.0) return frame;
    frame.meshFromLocal.postMultScale(osg::Vec3d(inverse, inverse, inverse));
    frame.localFromMesh.preMultScale(osg::Vec3d(unit, unit, unit));
    return frame;
}

void setBounds(CollectedGraph& graph, GeometryCache& geometries)
{
    for (CollectedGeometry& geometry : graph.geometries)
        geometry.bounds = &geometries.bounds(*geometry.geometry);
}

/// Of all that is traced, where the lengths of the graph are those of the world.
double unitOf(const CollectedGraph& graph)
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
    return lengths.unit();
}

bool isLinear(const CollectedGraph& graph, RayTraceSettings::ColorRule rule)
{
    if (rule != RayTraceSettings::AUTOMATIC_COLOR) return rule == RayTraceSettings::LINEAR;
    if (!graph.areaLights.empty()) return true;
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
    std::vector<std::shared_ptr<const Mesh>>
        areaLights; ///< their quads, in the order of the traversal
};

/// Adds the parts of one snapshot to its Scene.
class SceneBuilder
{
public:
    SceneBuilder(const ConversionInput& input, const CollectedGraph& graph, double unit,
                 bool linear, Stamp now, ConversionCaches& caches, ConversionReport& report)
        : _input(input),
          _graph(graph),
          _unit(unit),
          _linear(linear),
          _now(now),
          _caches(caches),
          _report(report),
          _materials(linear, caches.textures, report),
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
        for (const CollectedGeometry& geometry : _graph.geometries)
            addGeometry(geometry);
        _caches.areaLights.resize(_graph.areaLights.size());
        for (std::size_t i = 0; i < _graph.areaLights.size(); ++i)
            addAreaLight(_graph.areaLights[i], _caches.areaLights[i]);
        _scene->materials = _materials.take();
        _scene->textures = _caches.textures.end();
        addLights();
        if (_scene->materials.empty()) _scene->materials.push_back(fallbackMaterial());
        _report.count("converted.instance", _scene->instances.size());
        _report.count("converted.light", _scene->lights.size());
        return std::move(_scene);
    }

private:
    void addGeometry(const CollectedGeometry& geometry);
    void warnIfCoarse(const CollectedGeometry& geometry);
    Clipping clipBy(const CollectedGeometry& geometry, const GeometryUse& use,
                    MeshRequest& request);
    void addPlacedUses(const CollectedGeometry& geometry);
    void addBaked(const CollectedGeometry& geometry, const GeometryUse& use,
                  const std::shared_ptr<const Mesh>& mesh);
    void addInstance(const CollectedGeometry& geometry, const GeometryUse& use, Instance instance);
    void addAreaLight(const CollectedAreaLight& source, std::shared_ptr<const Mesh>& quad);
    void addLights();
    void setAmbient(const GraphState& state);
    uint32_t addMesh(const std::shared_ptr<const Mesh>& mesh);
    MeshRequest requestFor(const CollectedGeometry& geometry, const osg::Matrixd& transform) const;

    const ConversionInput& _input;
    const CollectedGraph& _graph;
    double _unit;
    bool _linear;
    Stamp _now;
    ConversionCaches& _caches;
    ConversionReport& _report;
    MaterialConverter _materials;
    std::shared_ptr<Scene> _scene;
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
    if (geometry.uses.size() > 1)
    {
        addPlacedUses(geometry);
        return;
    }
    const GeometryUse& use = geometry.uses.front();
    MeshRequest request = requestFor(geometry, use.engineFromLocal);
    request.lift = polygonLift(_graph.states[use.state]);
    if (clipBy(geometry, use, request) == Clipping::Wholly) return;
    addBaked(
        geometry, use,
        _caches.geometries.mesh(*geometry.geometry, kOwnVariant, request, geometry.path, _report));
}

void SceneBuilder::addBaked(const CollectedGeometry& geometry, const GeometryUse& use,
                            const std::shared_ptr<const Mesh>& mesh)
{
    if (!mesh) return;
    _report.count("converted.geometry");
    Instance instance;
    instance.mesh = addMesh(mesh);
    addInstance(geometry, use, instance);
}

void SceneBuilder::addPlacedUses(const CollectedGeometry& geometry)
{
    const MeshFrame frame = meshFrame(*geometry.bounds);
    const MeshRequest request = requestFor(geometry, frame.meshFromLocal);
    const auto mesh =
        _caches.geometries.mesh(*geometry.geometry, kOwnVariant, request, geometry.path, _report);
    if (!mesh) return;
    _report.count("converted.geometry");
    const uint32_t meshIndex = addMesh(mesh);
    uint32_t variant = kOwnVariant;
    for (const GeometryUse& use : geometry.uses)
    {
        ++variant;
        MeshRequest own = requestFor(geometry, use.engineFromLocal);
        own.lift = polygonLift(_graph.states[use.state]);
        const Clipping clipping = clipBy(geometry, use, own);
        if (clipping == Clipping::Wholly) continue;
        Instance instance;
        instance.mesh = meshIndex;
        instance.placed = true;
        instance.engineFromLocal = toAffine(frame.localFromMesh * use.engineFromLocal);
        if (clipping == Clipping::Partly || own.lift != 0.0f ||
            !isPlaceable(instance.engineFromLocal))
        {
            addBaked(geometry, use,
                     _caches.geometries.mesh(*geometry.geometry, variant, own, geometry.path,
                                             _report));
            continue;
        }
        const glm::dmat3 linear(instance.engineFromLocal.linear);
        instance.normalFromLocal = Mat3(glm::transpose(glm::inverse(linear)));
        instance.mirrored = glm::determinant(linear) < 0.0;
        addInstance(geometry, use, instance);
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
void SceneBuilder::addAreaLight(const CollectedAreaLight& source, std::shared_ptr<const Mesh>& quad)
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
    if (!quad || !std::equal(quad->positions.begin(), quad->positions.end(),
                             converted->mesh->positions.begin()))
    {
        converted->mesh->name = source.path;
        converted->mesh->changed = _now;
        quad = converted->mesh;
    }
    instance.mesh = addMesh(quad);
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
    const auto add = [&](const osg::Light& source, const osg::Matrixd& matrix, bool eyeSpace,
                         const std::string& path)
    {
        const int number = source.getLightNum();
        const auto light = convertLight(source, matrix, eyeSpace, _unit);
        if (!light || number < 0 || number >= 32)
        {
            _report.warn("skipped.light", "light '" + path + "'",
                         light ? "number is not 0 to 31, skipped"
                               : "values are not finite, skipped");
            return;
        }
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

    uint32_t enabled = 0;
    for (const Material& material : _scene->materials)
        if (material.lit) enabled |= material.lightMask;
    for (const auto& [number, light] : lights)
        if (enabled >> number & 1u) _scene->lights.push_back(light);
}

} // namespace

struct SceneConverter::Implementation
{
    ConversionCaches caches;
    std::shared_ptr<const Scene> last;
    Stamp stamp = 0;
};

SceneConverter::SceneConverter() : _implementation(std::make_unique<Implementation>()) {}

SceneConverter::~SceneConverter() = default;

void SceneConverter::forget()
{
    _implementation->caches = ConversionCaches();
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
    const double unit = unitOf(graph);
    applyUnit(unit, graph);
    state.caches.textures.begin(linear, now);
    SceneBuilder builder(input, graph, unit, linear, now, state.caches, report);
    state.last = stampChanges(builder.build(), state.last, now);
    state.caches.geometries.end();
    state.caches.vertices.end();

    ConversionResult result;
    result.scene = state.last;
    result.paged = graph.paged;
    result.counts = report.counts();
    const auto draws = [](const RasterizedPart& part) { return part.kind == RasterizedPart::Draw; };
    if (std::any_of(graph.rasterized.begin(), graph.rasterized.end(), draws))
        result.rasterized = std::make_shared<RasterizedParts>(std::move(graph.rasterized));
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

} // namespace osgRayTrace::engine
