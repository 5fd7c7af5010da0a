// TracedScene.cpp - builds Embree's structures for a Scene, and only what changed. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/TracedScene.h"

#include "osgRayTrace/accel/EmbreeDevice.h"
#include "osgRayTrace/accel/HitFilter.h"
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/SurfaceTable.h"
#include "osgRayTrace/base/Parallel.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

namespace osgRayTrace::engine
{

namespace
{

struct SceneRelease
{
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct GeometryRelease
{
    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneRelease>;
using GeometryHandle = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, GeometryRelease>;

/// A mesh with a BVH of its own, for instances of it. Shared by snapshots.
struct Prototype
{
    std::shared_ptr<EmbreeDevice> device;
    std::shared_ptr<const Mesh> mesh; ///< owns the shared buffers
    bool filtered = false;            ///< rays may pass what they meet: see HitFilter
    SceneHandle scene;
};

/// Embree's coordinates must stay below 1.8e18, also those of rays in the local space of instances.
constexpr double kLargestCoordinate = 1e18;

/// How far from the engine's origin a ray may start so that Embree can take it to the instance's local
/// space; 0 if Embree, which does so in float, cannot use the transform.
double reachOf(const Affine& m)
{
    double largest = 0.0, columnProduct = 1.0;
    for (int column = 0; column < 3; ++column)
    {
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::fabs(double(m.linear[column][row])));
        columnProduct *= glm::length(glm::dvec3(m.linear[column]));
    }
    // A flatter parallelepiped of columns has a determinant of rounding errors. NaN fails, too.
    const double determinant = glm::determinant(glm::dmat3(m.linear));
    if (!(largest < 1e12) || !(std::fabs(determinant) > 1e-6 * columnProduct)) return 0.0;

    const glm::dmat3 localFromEngine = glm::inverse(glm::dmat3(m.linear));
    double enlargement = 1.0; // largest sum of a row
    for (int row = 0; row < 3; ++row)
        enlargement = std::max(enlargement, std::fabs(localFromEngine[0][row]) + std::fabs(localFromEngine[1][row]) +
                                                std::fabs(localFromEngine[2][row]));
    const double reach = kLargestCoordinate / enlargement;
    const double distance = std::max({std::fabs(double(m.translation.x)), std::fabs(double(m.translation.y)),
                                      std::fabs(double(m.translation.z))});
    if (!(enlargement < 2e9) || !isFinite(m.translation) || distance > 0.5 * reach) return 0.0;
    return reach - distance;
}

GeometryHandle newTriangles(RTCDevice device, const Mesh& mesh, bool filtered)
{
    GeometryHandle geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh.positions.data(), 0, sizeof(Vec3), mesh.positions.size());
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.triangles.data(), 0, sizeof(UVec3), mesh.triangles.size());
    if (filtered) setHitFilter(geometry.get());
    rtcCommitGeometry(geometry.get());
    return geometry;
}

SceneHandle newScene(RTCDevice device)
{
    SceneHandle scene(rtcNewScene(device));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    return scene;
}

/// Throws EngineError if this or anything before it failed. Embree would build a geometry that lacks a
/// buffer, for want of memory, and read from nowhere.
void commit(EmbreeDevice& device, RTCScene scene)
{
    device.checkErrors();
    rtcCommitScene(scene);
    device.checkErrors();
}

GeometryHandle newInstance(RTCDevice device, RTCScene prototype, const Affine& m)
{
    GeometryHandle geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(geometry.get(), prototype);
    const float columns[12] = {m.linear[0].x,  m.linear[0].y,  m.linear[0].z,  m.linear[1].x,
                               m.linear[1].y,  m.linear[1].z,  m.linear[2].x,  m.linear[2].y,
                               m.linear[2].z,  m.translation.x, m.translation.y, m.translation.z};
    rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    rtcCommitGeometry(geometry.get());
    return geometry;
}

} // namespace

struct TracedScene::Implementation
{
    std::shared_ptr<EmbreeDevice> device; // first: destroyed last
    std::shared_ptr<const Scene> scene;
    std::unordered_map<const Mesh*, std::shared_ptr<const Prototype>> prototypes;
    SceneHandle root;
    std::unique_ptr<Intersector> intersector;
    SurfaceTable surfaces;
    std::unique_ptr<MaterialTable> materials;
    std::unique_ptr<LightTable> lights;
    SceneTraits traits;
    std::unique_ptr<HitFilter> filter;
    std::unordered_set<const Mesh*> filtered; ///< meshes that a partial material is on
    BuildStatistics statistics;

    const std::shared_ptr<const Prototype>& prototype(const std::shared_ptr<const Mesh>& mesh,
                                                      const Implementation* previous);
    void fillSurfaces();
    void findFiltered();
};

const std::shared_ptr<const Prototype>&
TracedScene::Implementation::prototype(const std::shared_ptr<const Mesh>& mesh,
                                       const Implementation* previous)
{
    std::shared_ptr<const Prototype>& entry = prototypes[mesh.get()];
    if (entry) return entry;
    if (previous)
    {
        const auto old = previous->prototypes.find(mesh.get());
        if (old != previous->prototypes.end() &&
            (old->second->filtered || filtered.count(mesh.get()) == 0))
            return entry = old->second;
    }
    auto built = std::make_shared<Prototype>();
    built->device = device;
    built->mesh = mesh;
    built->filtered = filtered.count(mesh.get()) != 0;
    built->scene = newScene(device->handle());
    rtcAttachGeometry(built->scene.get(),
                      newTriangles(device->handle(), *mesh, built->filtered).get());
    commit(*device, built->scene.get());
    ++statistics.builtMeshes;
    return entry = std::move(built);
}

void TracedScene::Implementation::fillSurfaces()
{
    surfaces.reserve(scene->instances.size());
    for (const Instance& instance : scene->instances)
    {
        const Mesh& mesh = *scene->meshes[instance.mesh];
        SurfaceRecord record;
        record.triangles = mesh.triangles.data();
        record.positions = mesh.positions.data();
        record.normals = mesh.normals.empty() ? nullptr : mesh.normals.data();
        record.uvs = mesh.uvs.empty() ? nullptr : mesh.uvs.data();
        record.uvs1 = mesh.uvs1.empty() ? nullptr : mesh.uvs1.data();
        record.colors = mesh.colors.empty() ? nullptr : mesh.colors.data();
        if (instance.placed) record.placed = &instance;
        record.material = instance.material;
        record.light = instance.light;
        surfaces.push_back(record);
    }
}

void TracedScene::Implementation::findFiltered()
{
    for (const Instance& instance : scene->instances)
        if ((*materials)[instance.material].partial)
            filtered.insert(scene->meshes[instance.mesh].get());
    filter = std::make_unique<HitFilter>(surfaces, *materials); // old prototypes may ask it
}

TracedScene::TracedScene() : _implementation(std::make_unique<Implementation>()) {}

TracedScene::~TracedScene() = default;

std::shared_ptr<const TracedScene> TracedScene::build(std::shared_ptr<const Scene> scene,
                                                      std::shared_ptr<Workers> workers,
                                                      std::shared_ptr<const TracedScene> previous)
{
    const auto begin = std::chrono::steady_clock::now();
    std::shared_ptr<TracedScene> traced(new TracedScene);
    Implementation& built = *traced->_implementation;
    const Implementation* old = previous ? previous->_implementation.get() : nullptr;
    built.device = old ? old->device : std::make_shared<EmbreeDevice>();
    built.scene = std::move(scene);
    const uint64_t bytesBefore = old ? built.device->bytes() : 0;

    built.materials = std::make_unique<MaterialTable>(*built.scene);
    built.fillSurfaces();
    built.findFiltered();
    double reach = kLargestCoordinate;
    workers->run(
        [&]
        {
            RTCDevice device = built.device->handle();
            built.root = newScene(device);
            for (std::size_t i = 0; i < built.scene->instances.size(); ++i)
            {
                const Instance& instance = built.scene->instances[i];
                const std::shared_ptr<const Mesh>& mesh = built.scene->meshes[instance.mesh];
                if (mesh->triangles.empty()) continue;
                if (isInvisible(built.scene->materials[instance.material])) continue;
                if (instance.placed)
                {
                    const double instanceReach = reachOf(instance.engineFromLocal);
                    if (instanceReach == 0.0)
                    {
                        ++built.statistics.invalidInstances;
                        continue;
                    }
                    reach = std::min(reach, instanceReach);
                }
                GeometryHandle geometry;
                if (instance.placed)
                {
                    const auto& prototype = built.prototype(mesh, old);
                    geometry = newInstance(device, prototype->scene.get(), instance.engineFromLocal);
                }
                else
                {
                    geometry = newTriangles(device, *mesh, built.filtered.count(mesh.get()) != 0);
                    ++built.statistics.builtMeshes;
                }
                rtcAttachGeometryByID(built.root.get(), geometry.get(), static_cast<unsigned>(i));
            }
            commit(*built.device, built.root.get());
        });

    built.intersector = std::make_unique<Intersector>(built.root.get(), built.device->nativeWidth(),
                                                      static_cast<float>(reach), built.filter.get());
    built.lights = std::make_unique<LightTable>(*built.scene);
    built.traits = sceneTraits(*built.scene);
    built.statistics.embreeBytes = built.device->bytes() - std::min(bytesBefore, built.device->bytes());
    built.statistics.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return traced;
}

const Scene& TracedScene::scene() const { return *_implementation->scene; }
const SceneTraits& TracedScene::traits() const { return _implementation->traits; }
const Intersector& TracedScene::intersector() const { return *_implementation->intersector; }
const SurfaceTable& TracedScene::surfaces() const { return _implementation->surfaces; }
const MaterialTable& TracedScene::materials() const { return *_implementation->materials; }
const LightTable& TracedScene::lights() const { return *_implementation->lights; }
const BuildStatistics& TracedScene::statistics() const { return _implementation->statistics; }

} // namespace osgRayTrace::engine
