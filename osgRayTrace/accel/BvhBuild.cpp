// BvhBuild.cpp - gives meshes to Embree. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/BvhBuild.h"

#include "osgRayTrace/accel/HitFilter.h"

#include <utility>

namespace osgRayTrace::engine
{

namespace
{

GeometryHandle newTriangles(RTCDevice device, const Mesh& mesh, bool filtered,
                            uint32_t mask = kEveryMask)
{
    GeometryHandle geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh.positions.data(), 0, sizeof(Vec3), mesh.positions.size());
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.triangles.data(), 0, sizeof(UVec3), mesh.triangles.size());
    if (filtered) setHitFilter(geometry.get());
    rtcSetGeometryMask(geometry.get(), mask);
    return geometry;
}

SceneHandle newScene(RTCDevice device)
{
    SceneHandle scene(rtcNewScene(device));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    return scene;
}

} // namespace

void commit(EmbreeDevice& device, RTCScene scene, BuildCounts& counts)
{
    device.checkErrors();
    rtcCommitScene(scene);
    ++counts.commits;
    device.checkErrors();
}

std::unique_ptr<MeshBvh> buildMesh(const std::shared_ptr<EmbreeDevice>& device,
                                   const std::shared_ptr<const Mesh>& mesh, bool filtered,
                                   BuildCounts& counts)
{
    auto built = std::make_unique<MeshBvh>();
    built->device = device;
    built->mesh = mesh;
    built->filtered = filtered;
    built->scene = newScene(device->handle());
    const GeometryHandle triangles = newTriangles(device->handle(), *mesh, filtered);
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
    commit(*device, built->scene.get(), counts);
    if (!mesh->deforms) built->outline.emplace(*mesh, boundsOf(built->scene.get()));
    ++counts.built;
    return built;
}

bool refitMesh(MeshBvh& spare, const std::shared_ptr<const Mesh>& mesh, bool filtered,
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
    commit(*spare.device, spare.scene.get(), counts);
    spare.mesh = mesh;
    spare.sound = true;
    ++counts.refit;
    return true;
}

std::shared_ptr<StaticBvh> buildStatic(const std::shared_ptr<EmbreeDevice>& device,
                                       StaticBvh::Members members,
                                       std::vector<std::shared_ptr<const Mesh>> owners,
                                       BuildCounts& counts)
{
    auto built = std::make_shared<StaticBvh>();
    built->device = device;
    built->members = std::move(members);
    built->owners = std::move(owners);
    built->scene = newScene(device->handle());
    for (const StaticBvh::Member& member : built->members)
    {
        const GeometryHandle triangles =
            newTriangles(device->handle(), *member.mesh, member.filtered, member.mask);
        rtcCommitGeometry(triangles.get());
        rtcAttachGeometryByID(built->scene.get(), triangles.get(), member.instance);
    }
    commit(*device, built->scene.get(), counts);
    counts.built += built->members.size();
    ++counts.staticBuilds;
    return built;
}

std::unique_ptr<TopLevelBvh> newTopLevel(const std::shared_ptr<EmbreeDevice>& device)
{
    auto topLevel = std::make_unique<TopLevelBvh>();
    topLevel->device = device;
    topLevel->placed = std::make_unique<PlacedScenes>(device->handle());
    topLevel->scene = newScene(device->handle());
    // Narrow nodes take a third less memory for the top level. Packets go through narrow nodes
    // faster, by a tenth at best, and single rays go slower by some percent.
    if (device->nativeWidth() == 16)
        rtcSetSceneFlags(topLevel->scene.get(),
                         RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT));
    rtcAttachGeometry(topLevel->scene.get(), topLevel->placed->geometry());
    return topLevel;
}

} // namespace osgRayTrace::engine
