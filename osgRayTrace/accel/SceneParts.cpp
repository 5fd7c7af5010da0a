// SceneParts.cpp - builds, refits and recycles BVHs. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/SceneParts.h"

#include "osgRayTrace/accel/HitFilter.h"

namespace osgRayTrace::engine
{

namespace
{

constexpr std::size_t kSpareRoots = 2;

GeometryHandle newTriangles(RTCDevice device, const Mesh& mesh, bool filtered)
{
    GeometryHandle geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh.positions.data(), 0, sizeof(Vec3), mesh.positions.size());
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.triangles.data(), 0, sizeof(UVec3), mesh.triangles.size());
    if (filtered) setHitFilter(geometry.get());
    return geometry;
}

SceneHandle newScene(RTCDevice device)
{
    SceneHandle scene(rtcNewScene(device));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    return scene;
}

/// Throws EngineError if this or anything before it failed. Embree would build a geometry that
/// lacks a buffer, for want of memory, and read from nowhere.
void commit(EmbreeDevice& device, RTCScene scene, BuildCounts& counts)
{
    device.checkErrors();
    rtcCommitScene(scene);
    ++counts.commits;
    device.checkErrors();
}

void place(RTCGeometry instance, const Placement& placement)
{
    const Affine& m = *placement.engineFromLocal;
    rtcSetGeometryInstancedScene(instance, placement.scene);
    const float columns[12] = {m.linear[0].x, m.linear[0].y,   m.linear[0].z,   m.linear[1].x,
                               m.linear[1].y, m.linear[1].z,   m.linear[2].x,   m.linear[2].y,
                               m.linear[2].z, m.translation.x, m.translation.y, m.translation.z};
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    rtcCommitGeometry(instance);
}

/// Takes out what is not placed like this; the next commit is that of the next use.
void detachOthers(RootPart& root, const std::vector<uint64_t>& prints)
{
    for (std::size_t i = 0; i < root.prints.size(); ++i)
    {
        if (root.prints[i] == 0 || (i < prints.size() && prints[i] == root.prints[i])) continue;
        rtcDetachGeometry(root.scene.get(), static_cast<unsigned int>(i));
        root.prints[i] = 0;
    }
}

} // namespace

template <class Part> std::shared_ptr<Part> PartPool::shared(std::unique_ptr<Part> part)
{
    const auto giveBackTo = [pool = weak_from_this()](Part* p)
    {
        std::unique_ptr<Part> owned(p);
        if (const std::shared_ptr<PartPool> alive = pool.lock()) alive->giveBack(std::move(owned));
    };
    return {part.release(), giveBackTo};
}

std::unique_ptr<Prototype> PartPool::build(const std::shared_ptr<const Mesh>& mesh,
                                           bool filtered, BuildCounts& counts)
{
    auto built = std::make_unique<Prototype>();
    built->device = _device;
    built->mesh = mesh;
    built->filtered = filtered;
    built->scene = newScene(_device->handle());
    const GeometryHandle triangles = newTriangles(_device->handle(), *mesh, filtered);
    if (mesh->deforms)
    {
        // Embree refits in these alone. The first build is of the usual quality.
        rtcSetSceneFlags(built->scene.get(),
                         RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC));
        rtcSetSceneBuildQuality(built->scene.get(), RTC_BUILD_QUALITY_LOW);
        rtcSetGeometryBuildQuality(triangles.get(), RTC_BUILD_QUALITY_REFIT);
        built->triangles = triangles.get();
        built->quality.emplace(*mesh);
    }
    rtcCommitGeometry(triangles.get());
    rtcAttachGeometry(built->scene.get(), triangles.get());
    commit(*_device, built->scene.get(), counts);
    built->serial = ++_serial;
    ++counts.built;
    return built;
}

/// False if it must be built.
bool PartPool::refit(Prototype& spare, const std::shared_ptr<const Mesh>& mesh, bool filtered,
                     BuildCounts& counts)
{
    if (mesh->positions.size() != spare.mesh->positions.size()) return false;
    if (mesh->triangles.size() != spare.mesh->triangles.size()) return false;
    if (spare.quality->degradation(*mesh) > kDegraded) return false;
    spare.sound = false;
    if (filtered && !spare.filtered) setHitFilter(spare.triangles);
    spare.filtered |= filtered;
    rtcSetSharedGeometryBuffer(spare.triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh->positions.data(), 0, sizeof(Vec3), mesh->positions.size());
    rtcUpdateGeometryBuffer(spare.triangles, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(spare.triangles);
    commit(*_device, spare.scene.get(), counts);
    spare.mesh = mesh;
    spare.serial = ++_serial;
    spare.sound = true;
    ++counts.refit;
    return true;
}

std::unique_ptr<Prototype> PartPool::spareOf(const UVec3* triangles)
{
    std::lock_guard<std::mutex> lock(_mutex);
    _wanted.insert(triangles);
    const auto found = _prototypes.find(triangles);
    if (found == _prototypes.end()) return nullptr;
    std::unique_ptr<Prototype> spare = std::move(found->second);
    _prototypes.erase(found);
    return spare;
}

std::shared_ptr<const Prototype> PartPool::prototype(const std::shared_ptr<const Mesh>& mesh,
                                                     bool filtered, BuildCounts& counts)
{
    if (mesh->deforms)
    {
        std::unique_ptr<Prototype> spare = spareOf(mesh->triangles.data());
        if (spare && refit(*spare, mesh, filtered, counts)) return shared(std::move(spare));
    }
    return shared(build(mesh, filtered, counts));
}

std::shared_ptr<const FlatPart> PartPool::flat(FlatPart::Members members,
                                               std::vector<std::shared_ptr<const Mesh>> owners,
                                               BuildCounts& counts)
{
    auto built = std::make_shared<FlatPart>();
    built->device = _device;
    built->members = std::move(members);
    built->owners = std::move(owners);
    built->scene = newScene(_device->handle());
    for (const FlatPart::Member& member : built->members)
    {
        const GeometryHandle triangles =
            newTriangles(_device->handle(), *member.mesh, member.filtered);
        rtcCommitGeometry(triangles.get());
        rtcAttachGeometryByID(built->scene.get(), triangles.get(), member.instance);
    }
    commit(*_device, built->scene.get(), counts);
    built->serial = ++_serial;
    counts.built += built->members.size();
    ++counts.flat;
    return built;
}

std::shared_ptr<const RootPart> PartPool::root(const std::vector<Placement>& placements,
                                               const std::vector<uint64_t>& prints,
                                               BuildCounts& counts)
{
    std::unique_ptr<RootPart> root;
    uint64_t generation = 0;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        generation = _generation;
        if (!_roots.empty())
        {
            root = std::move(_roots.back());
            _roots.pop_back();
        }
    }
    if (!root)
    {
        root = std::make_unique<RootPart>();
        root->device = _device;
        root->scene = newScene(_device->handle());
    }
    root->sound = false;
    root->generation = generation;
    const std::size_t before = root->prints.size();
    root->prints.resize(std::max(before, prints.size()), 0);
    bool changed = before == 0;
    for (std::size_t i = 0; i < root->prints.size(); ++i)
    {
        const uint64_t wanted = i < prints.size() ? prints[i] : 0;
        if (root->prints[i] == wanted) continue;
        changed = true;
        const auto id = static_cast<unsigned int>(i);
        if (wanted == 0)
            rtcDetachGeometry(root->scene.get(), id);
        else if (root->prints[i] != 0)
            place(rtcGetGeometry(root->scene.get(), id), placements[i]);
        else
        {
            const GeometryHandle instance(
                rtcNewGeometry(_device->handle(), RTC_GEOMETRY_TYPE_INSTANCE));
            place(instance.get(), placements[i]);
            rtcAttachGeometryByID(root->scene.get(), instance.get(), id);
        }
        root->prints[i] = wanted;
    }
    root->prints.resize(prints.size());
    if (changed) commit(*_device, root->scene.get(), counts);
    root->sound = true;
    return shared(std::move(root));
}

void PartPool::keepOnly(const std::unordered_set<const UVec3*>& triangles)
{
    std::vector<std::unique_ptr<Prototype>> gone; // freed after the lock
    std::lock_guard<std::mutex> lock(_mutex);
    _wanted = triangles;
    for (auto spare = _prototypes.begin(); spare != _prototypes.end();)
    {
        if (_wanted.count(spare->first))
        {
            ++spare;
            continue;
        }
        gone.push_back(std::move(spare->second));
        spare = _prototypes.erase(spare);
    }
}

void PartPool::keepPlacements(std::shared_ptr<const RootPart> newest)
{
    std::lock_guard<std::mutex> lock(_mutex);
    _kept = newest ? newest->prints : std::vector<uint64_t>();
    ++_generation;
    for (const std::unique_ptr<RootPart>& root : _roots)
    {
        detachOthers(*root, _kept);
        root->generation = _generation;
    }
}

void PartPool::giveBack(std::unique_ptr<Prototype> prototype)
{
    if (!prototype->sound || !prototype->triangles) return;
    std::lock_guard<std::mutex> lock(_mutex);
    const UVec3* const triangles = prototype->mesh->triangles.data();
    if (!_wanted.count(triangles)) return;
    try
    {
        _prototypes.emplace(triangles, std::move(prototype));
    }
    catch (const std::bad_alloc&)
    {
    }
}

void PartPool::giveBack(std::unique_ptr<RootPart> root)
{
    if (!root->sound) return;
    std::lock_guard<std::mutex> lock(_mutex);
    if (_roots.size() >= kSpareRoots) return;
    if (root->generation != _generation) detachOthers(*root, _kept);
    root->generation = _generation;
    try
    {
        _roots.push_back(std::move(root));
    }
    catch (const std::bad_alloc&)
    {
    }
}

} // namespace osgRayTrace::engine
