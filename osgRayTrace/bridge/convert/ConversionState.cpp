// ConversionState.cpp - when a scene shall have no flat BVH any more. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/ConversionState.h"

#include "osgRayTrace/base/NeverDestroyed.h"

#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Builds of a larger one for the sake of what leaves it; then all meshes get BVHs of their own.
constexpr int kMostFlatBuilds = 3;

} // namespace

void noteFlat(const Scene& scene, bool comparable, ConversionCaches& caches)
{
    std::vector<std::shared_ptr<const Mesh>> flat;
    uint64_t vertices = 0;
    for (const Instance& instance : scene.instances)
    {
        if (instance.placed) continue;
        flat.push_back(scene.meshes[instance.mesh]);
        vertices += flat.back()->positions.size();
    }
    const bool large = caches.flatVertices > kSmallFlat;
    if (comparable && large && flat != caches.flat && ++caches.flatBuilds >= kMostFlatBuilds)
        caches.dissolved = true;
    caches.flat = std::move(flat);
    caches.flatVertices = vertices;
}

const std::shared_ptr<const Mesh>& emptyMesh()
{
    static const NeverDestroyed<std::shared_ptr<const Mesh>> mesh(std::make_shared<const Mesh>());
    return *mesh;
}

} // namespace osgRayTrace::engine
