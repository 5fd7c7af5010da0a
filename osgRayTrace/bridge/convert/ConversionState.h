// ConversionState.h - the state that is kept between two Scenes of one graph. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/lights/EnvironmentConverter.h"
#include "osgRayTrace/bridge/appearance/materials/MaterialList.h"
#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"
#include "osgRayTrace/bridge/appearance/textures/VolumeImages.h"
#include "osgRayTrace/bridge/convert/ClippedUse.h"
#include "osgRayTrace/bridge/convert/ConvertedSubtree.h"
#include "osgRayTrace/bridge/convert/CullWatch.h"
#include "osgRayTrace/bridge/convert/SceneIndex.h"
#include "osgRayTrace/bridge/geometry/ClosedMesh.h"
#include "osgRayTrace/bridge/geometry/GeometryCache.h"
#include "osgRayTrace/bridge/graph/CollectedGraph.h"
#include "osgRayTrace/bridge/graph/ConversionInput.h"

#include <memory>
#include <optional>
#include <unordered_set>
#include <vector>

namespace osgRayTrace::engine
{

/// Vertices of a static BVH below which it is rebuilt in negligible time.
constexpr uint64_t kSmallStatic = 32768;

/// Vertices from which on what may be exchanged as a whole has a BVH of its own: rays find it there
/// about as fast as in the static BVH, which would be built again.
constexpr uint64_t kPlacedVertices = 256;

/// Holds parts that are converted again only if they have changed.
struct ConversionCaches
{
    SoftwareVertices vertices;
    RuleCaches rules;
    DrawableTriangles triangles;
    GeometryCache geometries;
    ClosedMeshes closedMeshes; ///< of bodies with an interior
    TextureConverter textures;
    EnvironmentConverter environment;
    VolumeImages volumes;
    struct Quad
    {
        std::shared_ptr<const Mesh> mesh;
        bool dynamic = false; ///< true: the quad has moved and is in no static BVH
        uint32_t instance = kInvalid;
        Light light;
    };
    std::vector<Quad> areaLights;                          ///< in the order of the traversal
    std::vector<std::shared_ptr<const Mesh>> staticMeshes; ///< all meshes that are not placed
    uint64_t staticVertices = 0;
    int staticBuilds = 0;     ///< builds of a large static BVH after something left it
    bool noStaticBvh = false; ///< true: there is no static BVH any more
    uint64_t movedPlanes = 0; ///< numbers, as bits, of clip planes that have moved: see ClippedUse
};

/// Records the static meshes. A large static BVH that must be built time and again is given up.
void recordStaticMeshes(const Scene& scene, bool comparable, ConversionCaches& caches);

/// Holds the sources of the last Scene. The nodes of the graph that it names are kept alive until
/// the next conversion or patch.
struct ConvertedGraph
{
    SceneIndex index;
    bool setsColor = false; ///< see MaterialRules
    MaterialList materials;
    LightSources lights;
    ConversionCounts lightCounts;        ///< counts of setLights
    std::optional<osg::Vec4> clearColor; ///< CollectedGraph::clearColor
    PlacedTexGens texGens;
    ClipPlanes clipPlanes;
    uint64_t cuttingPlanes = ~uint64_t(0); ///< CollectedGraph::cuttingPlanes; all: not converted
    uint64_t unwatchedPlanes = 0;          ///< CollectedGraph::unwatchedPlanes
    std::vector<ClippedUse> clipped;
    CullWatch cullWatch;
    ConvertedSubtrees subtrees;
    /// CollectedGraph::inScene; nothing: no conversion has come to its end.
    std::optional<std::unordered_set<const osg::Node*>> inScene;
    std::vector<uint32_t> instanceGaps, meshGaps; ///< indices that removed parts left
    uint32_t emptyMesh = kInvalid; ///< index of the mesh that instances in gaps refer to
};

/// Returns a mesh without triangles, whose instances are never hit.
const std::shared_ptr<const Mesh>& emptyMesh();

} // namespace osgRayTrace::engine
