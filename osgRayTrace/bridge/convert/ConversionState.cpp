// ConversionState.cpp - decides when a scene gets no static BVH any more. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/ConversionState.h"

#include "osgRayTrace/base/NeverDestroyed.h"

#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Largest number of builds of a large static BVH because something left it; after them all meshes
/// get BVHs of their own.
constexpr int kMostStaticBuilds = 3;

} // namespace

void recordStaticMeshes(const Scene& scene, bool comparable, ConversionCaches& caches)
{
    std::vector<std::shared_ptr<const Mesh>> staticMeshes;
    uint64_t vertices = 0;
    for (const Instance& instance : scene.instances)
    {
        if (instance.placed) continue;
        staticMeshes.push_back(scene.meshes[instance.mesh]);
        vertices += staticMeshes.back()->positions.size();
    }
    const bool large = caches.staticVertices > kSmallStatic;
    if (comparable && large && staticMeshes != caches.staticMeshes &&
        ++caches.staticBuilds >= kMostStaticBuilds)
        caches.noStaticBvh = true;
    caches.staticMeshes = std::move(staticMeshes);
    caches.staticVertices = vertices;
}

const std::shared_ptr<const Mesh>& emptyMesh()
{
    static const NeverDestroyed<std::shared_ptr<const Mesh>> mesh(std::make_shared<const Mesh>());
    return *mesh;
}

} // namespace osgRayTrace::engine
