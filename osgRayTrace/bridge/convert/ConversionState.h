// ConversionState.h - what is kept between two Scenes of one graph. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/lights/EnvironmentConverter.h"
#include "osgRayTrace/bridge/appearance/materials/MaterialList.h"
#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"
#include "osgRayTrace/bridge/convert/SceneIndex.h"
#include "osgRayTrace/bridge/geometry/GeometryCache.h"
#include "osgRayTrace/bridge/graph/ConversionInput.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// Vertices of the static BVH: fewer are built again in no time.
constexpr uint64_t kSmallStatic = 32768;

/// What is converted again only if it has changed.
struct ConversionCaches
{
    SoftwareVertices vertices;
    GeometryCache geometries;
    TextureConverter textures;
    EnvironmentConverter environment;
    struct Quad
    {
        std::shared_ptr<const Mesh> mesh;
        bool dynamic = false; ///< has moved: it is in no static BVH
        uint32_t instance = kInvalid;
        Light light;
    };
    std::vector<Quad> areaLights;                          ///< in the order of the traversal
    std::vector<std::shared_ptr<const Mesh>> staticMeshes; ///< all meshes that are not placed
    uint64_t staticVertices = 0;
    int staticBuilds = 0;     ///< of a large static BVH that something has left
    bool noStaticBvh = false; ///< there is no static BVH any more
};

/// If a large static BVH must be built time and again, there shall be none.
void recordStaticMeshes(const Scene& scene, bool comparable, ConversionCaches& caches);

/// What the last Scene was made of. Keeps those nodes of the graph that it names alive until the
/// next conversion or patch.
struct ConvertedGraph
{
    SceneIndex index;
    bool setsColor = false; ///< see MaterialRules
    MaterialList materials;
    LightSources lights;
    ConversionCounts lightCounts; ///< of setLights
    PlacedTexGens texGens;
    std::vector<uint32_t> instanceGaps, meshGaps; ///< what was removed left them
    uint32_t emptyMesh = kInvalid;                ///< index of the mesh that gaps are instances of
};

/// A mesh without triangles: an instance of it is none.
const std::shared_ptr<const Mesh>& emptyMesh();

} // namespace osgRayTrace::engine
