// BvhPool.h - the BVHs of a TracedScene, and who may change them. Layer: accel; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/BvhQuality.h"
#include "osgRayTrace/accel/EmbreeDevice.h"
#include "osgRayTrace/accel/PlacedScenes.h"
#include "osgRayTrace/scene/Mesh.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>
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

/// Keeps parts that no version of the scene uses any more, so that the next version can be made by
/// changing these parts. A draw thread may still trace the last version, so there are two of each
/// part that changes, in turn. A part in a version is never changed. The thread that builds takes
/// spare parts, and whoever lets a version go gives parts back.
class BvhPool : public std::enable_shared_from_this<BvhPool>
{
public:
    explicit BvhPool(std::shared_ptr<EmbreeDevice> device) : _device(std::move(device)) {}

    const std::shared_ptr<EmbreeDevice>& device() const { return _device; }

    /// Returns a BVH of the mesh: a refitted one if there is a spare BVH with the same triangles
    /// that does not suffer by the refit, else a new one.
    std::shared_ptr<const MeshBvh> meshBvh(const std::shared_ptr<const Mesh>& mesh, bool filtered,
                                           BuildCounts& counts);

    std::shared_ptr<const StaticBvh> staticBvh(StaticBvh::Members members,
                                               std::vector<std::shared_ptr<const Mesh>> owners,
                                               BuildCounts& counts);

    /// Returns a top level with these placements; a spare top level is changed only in places that
    /// differ.
    std::shared_ptr<const TopLevelBvh> topLevel(const std::vector<Placement>& placements,
                                                BuildCounts& counts);

    /// Forgets, after something was removed, spare BVHs of meshes with other triangles than these,
    /// and all top levels that exist, spare or not: the top levels have room for what is gone.
    void keepOnly(const std::unordered_set<const UVec3*>& triangles);

    /// Takes a part back, or deletes the part. Any thread may call giveBack.
    void giveBack(std::unique_ptr<MeshBvh> meshBvh);
    void giveBack(std::unique_ptr<TopLevelBvh> topLevel);

private:
    template <class Part> std::shared_ptr<Part> shared(std::unique_ptr<Part> part);
    std::unique_ptr<MeshBvh> spareOf(const UVec3* triangles);
    std::unique_ptr<MeshBvh> build(const std::shared_ptr<const Mesh>& mesh, bool filtered,
                                   BuildCounts& counts);
    bool refit(MeshBvh& spare, const std::shared_ptr<const Mesh>& mesh, bool filtered,
               BuildCounts& counts);

    std::shared_ptr<EmbreeDevice> _device;
    std::atomic<uint64_t> _serial{0};

    std::mutex _mutex; // guards all below: the thread that builds and those that let versions go
    std::unordered_set<const UVec3*> _wanted; ///< the triangles of meshes that may be refitted
    std::unordered_multimap<const UVec3*, std::unique_ptr<MeshBvh>> _meshBvhs;
    std::vector<std::unique_ptr<TopLevelBvh>> _topLevels;
    uint64_t _generation = 0;
};

} // namespace osgRayTrace::engine
