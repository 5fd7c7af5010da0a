// SceneConverter.h - from an OpenSceneGraph scene graph to a Scene of the engine. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/ConversionReport.h"
#include "osgRayTrace/bridge/GraphChanges.h"
#include "osgRayTrace/bridge/LightSizes.h"
#include "osgRayTrace/bridge/MaterialLibrary.h"
#include "osgRayTrace/bridge/RasterizedParts.h"
#include "osgRayTrace/bridge/ReferenceView.h"
#include "osgRayTrace/scene/Scene.h"

#include <osgRayTrace/RayTraceSettings>

#include <osg/Light>
#include <osg/Node>
#include <osg/StateSet>
#include <osg/Vec3d>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

class PickIndex;

/// Settings that a conversion depends on.
struct ConversionSettings
{
    RayTraceSettings::ColorRule colorRule = RayTraceSettings::AUTOMATIC_COLOR;
    bool cullAllRays = false;
    bool headlightShadows = false;
    LightSizes lightSizes;
    std::shared_ptr<const MaterialLibrary> materials; ///< null: those of the graph only

    bool operator==(const ConversionSettings& other) const
    {
        return colorRule == other.colorRule && cullAllRays == other.cullAllRays &&
               headlightShadows == other.headlightShadows && lightSizes == other.lightSizes &&
               materials == other.materials;
    }
};

inline ConversionSettings conversionSettings(const RayTraceSettings& settings,
                                             std::shared_ptr<const MaterialLibrary> materials)
{
    return {settings.getColorRule(), settings.getCullAllRays(), settings.getHeadlightShadows(),
            lightSizesOf(settings), std::move(materials)};
}

/// What to convert a graph for.
struct ConversionInput : ConversionSettings
{
    osg::Node* root = nullptr;
    osg::Vec3d eye; ///< world space: levels of detail
    /// With the same eye: sizes in pixels, and what turns to the view or moves with it. Without one
    /// that is as if looked at from the eye, upright in the world.
    std::optional<ReferenceView> view;
    osg::Vec3d origin; ///< of the engine's coordinates, world space
    unsigned int traversalMask = 0xffffffffu;
    /// The light that osgViewer adds outside of the graph; null: none. In view space (headlight) or
    /// world space (sky light). Replaced by a light of the same number in the graph.
    osg::ref_ptr<const osg::Light> viewLight;
    bool viewLightInEyeSpace = true;
    bool lighting = true; ///< GL_LIGHTING above the root: off in osg::View's NO_LIGHT mode
    /// State above the root, the outermost first: of a cull traversal. Empty: osgViewer's defaults.
    std::vector<osg::ref_ptr<const osg::StateSet>> inheritedState;
    /// What OpenGL draws better goes on being drawn by it, see ConversionResult::rasterized. Else
    /// there is no OpenGL, and everything with triangles is traced.
    bool rasterizesRest = false;
    bool picks = false; ///< what rays hit is looked up: see ConversionResult::pickIndex
    osg::Vec4 clearColor{0.2f, 0.2f, 0.4f, 1.0f}; ///< as shown
};

struct ConversionResult
{
    std::shared_ptr<const Scene> scene; ///< never null
    ConversionCounts counts;
    ConversionPaths paths; ///< of what is counted, the first few
    /// For OSG to draw; null if nothing is, or ConversionInput::rasterizesRest is not set.
    std::shared_ptr<const RasterizedParts> rasterized;
    std::shared_ptr<const PickIndex> pickIndex; ///< null unless ConversionInput::picks
    bool paged = false; ///< parts of the graph are files that are read when they are seen
    /// Of those in the scene: what was removed left them, and they hold nothing.
    std::size_t emptyInstances = 0, emptyMeshes = 0;
    double seconds = 0.0;
};

/// Keeps what it needs to share unchanged parts between snapshots. Used by one thread at a time.
class SceneConverter
{
public:
    SceneConverter();
    ~SceneConverter();

    /// Converts the graph as it is now. The graph is read, not changed (bounds may be computed).
    /// Warns once an object through osg::notify. Bad data is skipped and counted; throws
    /// std::bad_alloc only. Geometry and images are taken as unchanged while their modified counts
    /// are (see GeometryCache and TextureConverter); an unchanged graph gives the last Scene
    /// itself.
    ConversionResult convert(const ConversionInput& input);

    /// The last scene with these changes alone redone; the scene itself if they change nothing.
    /// Nothing: call convert(). The graph has no other changes since the last call of either, which
    /// did not throw.
    std::optional<ConversionResult> patch(const GraphChanges& changes);

    /// Meshes that were made from arrays, ever.
    uint64_t convertedMeshes() const;

    /// Keeps nothing of the graph alive until the next call of convert(), which comes before one of
    /// patch(); but for arrays and images that have not changed by then.
    void releaseGraph();

    /// The next conversion reads all arrays and images again, whatever their modified counts say.
    void forget();

private:
    struct Implementation;
    std::unique_ptr<Implementation> _implementation;
};

} // namespace osgRayTrace::engine
