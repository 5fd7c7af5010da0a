// BvhPool.cpp - builds, refits and recycles BVHs. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/BvhPool.h"

#include "osgRayTrace/accel/HitFilter.h"

namespace osgRayTrace::engine
{

namespace
{

constexpr std::size_t kSpareTopLevels = 2;

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

/// Commits the scene. Throws EngineError if the commit or anything before it failed: Embree would
/// build a geometry that lacks a buffer for want of memory, and would read from an invalid address.
void commit(EmbreeDevice& device, RTCScene scene, BuildCounts& counts)
{
    device.checkErrors();
    rtcCommitScene(scene);
    ++counts.commits;
    device.checkErrors();
}

} // namespace

template <class Part> std::shared_ptr<Part> BvhPool::shared(std::unique_ptr<Part> part)
{
    const auto giveBackTo = [pool = weak_from_this()](Part* p)
    {
        std::unique_ptr<Part> owned(p);
        if (const std::shared_ptr<BvhPool> alive = pool.lock()) alive->giveBack(std::move(owned));
    };
    return {part.release(), giveBackTo};
}

std::unique_ptr<MeshBvh> BvhPool::build(const std::shared_ptr<const Mesh>& mesh, bool filtered,
                                        BuildCounts& counts)
{
    auto built = std::make_unique<MeshBvh>();
    built->device = _device;
    built->mesh = mesh;
    built->filtered = filtered;
    built->scene = newScene(_device->handle());
    const GeometryHandle triangles = newTriangles(_device->handle(), *mesh, filtered);
    if (mesh->deforms)
    {
        // Embree refits only scenes with these settings. The first build has the usual quality.
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

/// Refits the spare BVH to the mesh. Returns false if the BVH must be built instead.
bool BvhPool::refit(MeshBvh& spare, const std::shared_ptr<const Mesh>& mesh, bool filtered,
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

std::unique_ptr<MeshBvh> BvhPool::spareOf(const UVec3* triangles)
{
    std::lock_guard<std::mutex> lock(_mutex);
    _wanted.insert(triangles);
    const auto found = _meshBvhs.find(triangles);
    if (found == _meshBvhs.end()) return nullptr;
    std::unique_ptr<MeshBvh> spare = std::move(found->second);
    _meshBvhs.erase(found);
    return spare;
}

std::shared_ptr<const MeshBvh> BvhPool::meshBvh(const std::shared_ptr<const Mesh>& mesh,
                                                bool filtered, BuildCounts& counts)
{
    if (mesh->deforms)
    {
        std::unique_ptr<MeshBvh> spare = spareOf(mesh->triangles.data());
        if (spare && refit(*spare, mesh, filtered, counts)) return shared(std::move(spare));
    }
    return shared(build(mesh, filtered, counts));
}

std::shared_ptr<const StaticBvh> BvhPool::staticBvh(StaticBvh::Members members,
                                                    std::vector<std::shared_ptr<const Mesh>> owners,
                                                    BuildCounts& counts)
{
    auto built = std::make_shared<StaticBvh>();
    built->device = _device;
    built->members = std::move(members);
    built->owners = std::move(owners);
    built->scene = newScene(_device->handle());
    for (const StaticBvh::Member& member : built->members)
    {
        const GeometryHandle triangles =
            newTriangles(_device->handle(), *member.mesh, member.filtered);
        rtcCommitGeometry(triangles.get());
        rtcAttachGeometryByID(built->scene.get(), triangles.get(), member.instance);
    }
    commit(*_device, built->scene.get(), counts);
    built->serial = ++_serial;
    counts.built += built->members.size();
    ++counts.staticBuilds;
    return built;
}

std::shared_ptr<const TopLevelBvh> BvhPool::topLevel(const std::vector<Placement>& placements,
                                                     BuildCounts& counts)
{
    std::unique_ptr<TopLevelBvh> topLevel;
    uint64_t generation = 0;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        generation = _generation;
        if (!_topLevels.empty())
        {
            topLevel = std::move(_topLevels.back());
            _topLevels.pop_back();
        }
    }
    const bool fresh = !topLevel;
    if (fresh)
    {
        topLevel = std::make_unique<TopLevelBvh>();
        topLevel->device = _device;
        topLevel->placed = std::make_unique<PlacedScenes>(_device->handle());
        topLevel->scene = newScene(_device->handle());
        // Narrow nodes take a third less memory for the top level. Packets go through narrow nodes
        // faster, by a tenth at best, and single rays go slower by some percent.
        if (_device->nativeWidth() == 16)
            rtcSetSceneFlags(topLevel->scene.get(),
                             RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT));
        rtcAttachGeometry(topLevel->scene.get(), topLevel->placed->geometry());
    }
    topLevel->sound = false;
    topLevel->generation = generation;
    if (topLevel->placed->set(placements) || fresh) commit(*_device, topLevel->scene.get(), counts);
    topLevel->sound = true;
    return shared(std::move(topLevel));
}

void BvhPool::keepOnly(const std::unordered_set<const UVec3*>& triangles)
{
    std::vector<std::unique_ptr<MeshBvh>> gone; // parts to free after the lock
    std::vector<std::unique_ptr<TopLevelBvh>> roots;
    std::lock_guard<std::mutex> lock(_mutex);
    _wanted = triangles;
    for (auto spare = _meshBvhs.begin(); spare != _meshBvhs.end();)
    {
        if (_wanted.count(spare->first))
        {
            ++spare;
            continue;
        }
        gone.push_back(std::move(spare->second));
        spare = _meshBvhs.erase(spare);
    }
    ++_generation;
    roots.swap(_topLevels);
}

void BvhPool::giveBack(std::unique_ptr<MeshBvh> meshBvh)
{
    if (!meshBvh->sound || !meshBvh->triangles) return;
    std::lock_guard<std::mutex> lock(_mutex);
    const UVec3* const triangles = meshBvh->mesh->triangles.data();
    if (!_wanted.count(triangles)) return;
    try
    {
        _meshBvhs.emplace(triangles, std::move(meshBvh));
    }
    catch (const std::bad_alloc&)
    {
    }
}

void BvhPool::giveBack(std::unique_ptr<TopLevelBvh> topLevel)
{
    if (!topLevel->sound) return;
    std::lock_guard<std::mutex> lock(_mutex);
    if (topLevel->generation != _generation || _topLevels.size() >= kSpareTopLevels) return;
    try
    {
        _topLevels.push_back(std::move(topLevel));
    }
    catch (const std::bad_alloc&)
    {
    }
}

} // namespace osgRayTrace::engine
