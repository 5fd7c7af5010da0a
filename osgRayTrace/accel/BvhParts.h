// BvhParts.h - the BVHs that a TracedScene is made of. Layer: accel; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/BvhQuality.h"
#include "osgRayTrace/accel/EmbreeDevice.h"
#include "osgRayTrace/accel/PlacedScenes.h"
#include "osgRayTrace/scene/Mesh.h"

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

struct SceneRelease
{
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneRelease>;

/// Counts of the work done while a scene is built, by several threads.
struct BuildCounts
{
    std::atomic<std::size_t> built{0}, refit{0}, staticBuilds{0}, commits{0};
};

/// A mesh with a BVH of its own, for instances of it.
struct MeshBvh
{
    std::shared_ptr<EmbreeDevice> device; // first member: destroyed last
    std::shared_ptr<const Mesh> mesh;     ///< the owner of the buffers that Embree reads
    bool filtered = false;                ///< whether rays may pass what they meet: see HitFilter
    SceneHandle scene;
    std::optional<Outline> outline;    ///< null: the mesh deforms
    RTCGeometry triangles = nullptr;   ///< the scene's own; set if the BVH can be refitted
    std::optional<BvhQuality> quality; ///< set if the BVH can be refitted
    uint64_t serial = 0;               ///< a new number for each build and refit
    bool sound = true;                 ///< false during a change
};

/// The BVH of all meshes that have never moved, attached by the indices of their instances.
struct StaticBvh
{
    struct Member
    {
        uint32_t instance = 0;
        const Mesh* mesh = nullptr;
        bool filtered = false; ///< as in MeshBvh
        uint32_t mask = 0;     ///< of the rays that meet it
    };
    using Members = std::vector<Member>;

    std::shared_ptr<EmbreeDevice> device;
    Members members;
    std::vector<std::shared_ptr<const Mesh>> owners;
    SceneHandle scene;
    uint64_t serial = 0;
};

/// The BVH over instances.
struct TopLevelBvh
{
    std::shared_ptr<EmbreeDevice> device;
    std::unique_ptr<PlacedScenes> placed;
    SceneHandle scene;
    uint64_t generation = 0;
    bool sound = true; ///< false during a change
};

} // namespace osgRayTrace::engine
