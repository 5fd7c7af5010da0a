// CollectedGraph.h - what GraphCollector has found in a scene graph. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/textures/TextureUnits.h"
#include "osgRayTrace/bridge/common/ClipPlanes.h"
#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/bridge/common/SceneExtent.h"
#include "osgRayTrace/bridge/common/StateStack.h"
#include "osgRayTrace/bridge/geometry/TriangleList.h"
#include "osgRayTrace/bridge/graph/CullOutcome.h"
#include "osgRayTrace/bridge/graph/NodeTree.h"
#include "osgRayTrace/bridge/graph/RasterizedParts.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/EnvironmentLight>
#include <osgRayTrace/MediumVolume>
#include <osgRayTrace/PhysicalMaterial>

#include <osg/Geometry>
#include <osg/LightSource>
#include <osg/Matrixd>
#include <osgVolume/VolumeTile>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

namespace osgRayTrace::engine
{

constexpr uint32_t kNoSubtree = 0xffffffffu;

/// Names a subtree into which GraphWatch does not look node by node: what is at and below the
/// outermost node of an unknown class on a path, or the outermost one whose cull traversal stands
/// for what is below.
struct UnwatchedSubtree
{
    osg::NodePath path;                     ///< from the root to that node
    ConversionCounts counts;                ///< what the collector has counted there
    std::vector<const osg::Geometry*> left; ///< its share of CollectedGraph::leftGeometries
    std::size_t parts = 0;                  ///< number of parts that OSG draws before its own
    bool special = false;                   ///< something in it shines or places state for others
};

/// A use is one path to a geometry.
struct GeometryUse
{
    osg::Matrixd engineFromLocal;    ///< affine, finite, invertible; see applyUnit
    uint32_t state = 0;              ///< index into CollectedGraph::states
    uint32_t path = NodeTree::kNone; ///< index into CollectedGraph::paths; kNone: no picks
    bool proxy = false;              ///< OSG draws the use, and camera rays pass it: see Proxies.h
    /// Number of the leaf of a cull traversal that the use stands for, see CulledLeaf.
    uint32_t culled = kNoCulledLeaf;
    uint32_t subtree = kNoSubtree; ///< index into CollectedGraph::subtrees
};

struct CollectedGeometry
{
    osg::ref_ptr<const osg::Geometry> geometry;
    std::string path; ///< path of the first use: "root/child/geometry"
    std::vector<GeometryUse> uses;
    PrimitiveRestart restart; ///< primitive restart of all uses
    float pointRadius = 0.0f; ///< radius of its points and lines; 0: they are left to OSG
    bool watched = true;      ///< no path is below a node that GraphWatch does not look into
    const VertexBounds* bounds = nullptr; ///< bounds that SceneConverter sets

    /// Returns whether OSG draws all uses: what is left out of a proxy is not missing in a picture.
    bool isProxy() const
    {
        return std::all_of(uses.begin(), uses.end(),
                           [](const GeometryUse& use) { return use.proxy; });
    }

    /// Returns whether all uses stand for leaves of cull traversals, which CullWatch looks at.
    bool isCulled() const
    {
        return std::all_of(uses.begin(), uses.end(),
                           [](const GeometryUse& use) { return use.culled != kNoCulledLeaf; });
    }
};

/// Names a use whose proxy is left out because it encloses the scene, or the largest of all uses if
/// it is a proxy that may come to enclose it.
struct Enclosure
{
    osg::ref_ptr<const osg::Geometry> geometry;
    osg::Matrixd engineFromLocal;
    VertexBounds bounds;
    bool encloses = true; ///< false: it has a proxy, as something is outside
    bool moved = false;   ///< in the patch that is being made
};

struct CollectedLight
{
    osg::ref_ptr<const osg::LightSource> source;
    osg::Matrixd engineFromLocal; ///< identity in eye space
    bool eyeSpace = false;
    std::string path;
};

struct CollectedAreaLight
{
    osg::ref_ptr<const AreaLight> light;
    osg::Matrixd engineFromLocal;
    std::string path;
    uint32_t pickPath = NodeTree::kNone; ///< index like GeometryUse::path
};

struct CollectedEnvironment
{
    osg::ref_ptr<const EnvironmentLight> light;
    osg::Matrixd engineFromLocal;
    std::string path;
};

struct CollectedVolume
{
    osg::ref_ptr<const MediumVolume> volume;
    osg::Matrixd engineFromLocal;
    std::string path;
};

/// A tile of osgVolume that is traced.
struct CollectedTile
{
    osg::ref_ptr<const osgVolume::VolumeTile> tile;
    osg::Matrixd engineFromLocal;
    std::string path;
    osg::ref_ptr<const PhysicalMaterial> material; ///< of its state; null: there is none
    osg::Vec4 diffuse{1.0f, 1.0f, 1.0f, 1.0f};     ///< of the OpenGL material of its own state
};

/// The lights stand in the order of the traversal.
struct LightSources
{
    std::vector<CollectedLight> lights;
    std::vector<CollectedAreaLight> areaLights;
    std::vector<CollectedEnvironment> environments;
    std::vector<CollectedVolume> volumes; ///< which are what light travels through
    std::vector<CollectedTile> tiles;     ///< likewise
};

/// The attributes of states belong to the collector's state sets and are valid as long as the
/// collector lives. The collected graph keeps all else alive, even if a node of the application's
/// changes the scene graph during the traversal.
struct CollectedGraph
{
    std::vector<CollectedGeometry> geometries; ///< geometries in the order of their first use
    LightSources lights;
    std::vector<GraphState> states;
    PlacedTexGens texGens; ///< last generation of each unit, as OpenGL keeps it
    ClipPlanes clipPlanes;
    uint64_t cuttingPlanes = 0; ///< numbers, as bits, of planes that are on for some use
    /// Numbers, as bits, of planes that nodes set into which GraphWatch does not look.
    uint64_t unwatchedPlanes = 0;
    std::optional<osg::Vec4>
        clearColor;     ///< colour of the last osg::ClearNode, if ConversionInput::rasterizesRest
    bool paged = false; ///< see ConversionResult
    std::vector<Enclosure> enclosures;        ///< dropped from geometries, or may be
    bool hasProxies = false;                  ///< some use is a proxy
    RasterizedParts rasterized;               ///< parts for OSG, if ConversionInput::rasterizesRest
    NodeTree paths;                           ///< paths to pick, if ConversionInput::picks
    std::vector<uint32_t> rasterizedPaths;    ///< paths of rasterized, if ConversionInput::picks
    std::vector<uint32_t> rasterizedSubtrees; ///< index of each part's subtree, or kNoSubtree
    std::vector<UnwatchedSubtree> subtrees;   ///< in the order of the traversal
    std::vector<CullOutcome> cullOutcomes;    ///< decisions on subtrees that may draw in cull alone
    bool cullUnknown = false; ///< true: there was no view that could decide on such a subtree
    /// Outermost nodes on their paths whose class GraphWatch does not know, if anything at or below
    /// them is traced, has a proxy, shines or places state.
    std::unordered_set<const osg::Node*> inScene;
    std::vector<const osg::Geometry*> leftGeometries; ///< geometries in groups of rasterized
};

} // namespace osgRayTrace::engine
