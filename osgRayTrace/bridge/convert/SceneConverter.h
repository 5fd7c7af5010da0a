// SceneConverter.h - from an OpenSceneGraph scene graph to a Scene of the engine. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/changes/GraphChanges.h"
#include "osgRayTrace/bridge/convert/ConversionResult.h"
#include "osgRayTrace/bridge/graph/ConversionInput.h"

#include <memory>
#include <optional>

namespace osgRayTrace::engine
{

struct PatchResult
{
    std::optional<ConversionResult> conversion; ///< nothing: the whole graph must be converted
    ConversionReason reason;                    ///< why there is nothing
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
    /// No conversion: call convert(). The graph has no other changes since the last call of either,
    /// which did not throw.
    PatchResult patch(const GraphChanges& changes);

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
