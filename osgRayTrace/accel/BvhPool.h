// BvhPool.h - who may change the BVHs of a TracedScene, and when. Layer: accel; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/BvhParts.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

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

    std::shared_ptr<EmbreeDevice> _device;
    std::atomic<uint64_t> _serial{0};

    std::mutex _mutex; // guards all below: the thread that builds and those that let versions go
    std::unordered_set<const UVec3*> _wanted; ///< the triangles of meshes that may be refitted
    std::unordered_multimap<const UVec3*, std::unique_ptr<MeshBvh>> _meshBvhs;
    std::vector<std::unique_ptr<TopLevelBvh>> _topLevels;
    uint64_t _generation = 0;
};

} // namespace osgRayTrace::engine
