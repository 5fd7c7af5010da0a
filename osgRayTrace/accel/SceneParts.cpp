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

std::unique_ptr<Prototype> PartPool::build(const std::shared_ptr<const Mesh>& mesh, bool filtered,
                                           BuildCounts& counts)
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
    if (!mesh->deforms) built->outline.emplace(*mesh, boundsOf(built->scene.get()));
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
    const bool fresh = !root;
    if (fresh)
    {
        root = std::make_unique<RootPart>();
        root->device = _device;
        root->placed = std::make_unique<PlacedScenes>(_device->handle());
        root->scene = newScene(_device->handle());
        // Narrow nodes: a third of the top level's memory less. Packets go through them faster, by
        // a tenth at best, single rays slower by some percent.
        if (_device->nativeWidth() == 16)
            rtcSetSceneFlags(root->scene.get(),
                             RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT));
        rtcAttachGeometry(root->scene.get(), root->placed->geometry());
    }
    root->sound = false;
    root->generation = generation;
    if (root->placed->set(placements) || fresh) commit(*_device, root->scene.get(), counts);
    root->sound = true;
    return shared(std::move(root));
}

void PartPool::keepOnly(const std::unordered_set<const UVec3*>& triangles)
{
    std::vector<std::unique_ptr<Prototype>> gone; // freed after the lock
    std::vector<std::unique_ptr<RootPart>> roots;
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
    ++_generation;
    roots.swap(_roots);
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
    if (root->generation != _generation || _roots.size() >= kSpareRoots) return;
    try
    {
        _roots.push_back(std::move(root));
    }
    catch (const std::bad_alloc&)
    {
    }
}

} // namespace osgRayTrace::engine
