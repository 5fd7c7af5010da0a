// BvhPool.cpp - recycles BVHs. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/BvhPool.h"

#include "osgRayTrace/accel/BvhBuild.h"

namespace osgRayTrace::engine
{

namespace
{

constexpr std::size_t kSpareTopLevels = 2;

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
        if (spare && refitMesh(*spare, mesh, filtered, counts))
        {
            spare->serial = ++_serial;
            return shared(std::move(spare));
        }
    }
    std::unique_ptr<MeshBvh> built = buildMesh(_device, mesh, filtered, counts);
    built->serial = ++_serial;
    return shared(std::move(built));
}

std::shared_ptr<const StaticBvh> BvhPool::staticBvh(StaticBvh::Members members,
                                                    std::vector<std::shared_ptr<const Mesh>> owners,
                                                    BuildCounts& counts)
{
    const std::shared_ptr<StaticBvh> built =
        buildStatic(_device, std::move(members), std::move(owners), counts);
    built->serial = ++_serial;
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
    if (fresh) topLevel = newTopLevel(_device);
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
