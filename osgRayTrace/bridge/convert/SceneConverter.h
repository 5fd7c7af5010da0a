// SceneConverter.h - converts an OpenSceneGraph scene graph to a Scene of the engine. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/changes/GraphChanges.h"
#include "osgRayTrace/bridge/changes/GraphWatch.h"
#include "osgRayTrace/bridge/common/ViewingConditions.h"
#include "osgRayTrace/bridge/convert/ConversionResult.h"
#include "osgRayTrace/bridge/convert/CullWatch.h"
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

/// Converts graphs and keeps the state that it needs to share unchanged parts between snapshots.
/// Only one thread may use a converter at a time.
class SceneConverter
{
public:
    SceneConverter();
    ~SceneConverter();

    /// Converts the graph as it is now. The graph is read, not changed (bounds may be computed).
    /// The converter warns once an object through osg::notify. Bad data is skipped and counted;
    /// only std::bad_alloc is thrown. Geometry and images are taken as unchanged while their
    /// modified counts stay (see GeometryCache and TextureConverter); an unchanged graph gives the
    /// last Scene itself.
    ConversionResult convert(const ConversionInput& input);

    /// Returns the last scene with these changes alone applied, or the last scene itself if they
    /// change nothing. conditions: those under which the changes were found. The result has no
    /// conversion, but a reason, if convert() has to be called. The graph must have no other
    /// changes since the last call of convert() or patch() that did not throw.
    PatchResult patch(const GraphChanges& changes, const ViewingConditions& conditions);

    /// Returns what the nodes that draw in cull alone show in this view otherwise than it was
    /// converted. Such nodes run, and may change the graph. Only bad_alloc is thrown. The changes
    /// must be applied by patch(), or the graph converted.
    CullChanges lookInCull(const ViewingConditions& conditions);

    /// Returns the nodes whose cull traversals lookInCull() follows, and those that are in the
    /// scene. The result refers to the last conversion.
    ConvertedNodes convertedNodes() const;

    /// Adds the changes of cull traversals to those of the graph. They take the place of what the
    /// graph tells of geometries that cull traversals alone have shown.
    void addCullChanges(const CullChanges& cull, GraphChanges& changes) const;

    /// Returns the number of meshes that were ever made from arrays.
    uint64_t convertedMeshes() const;

    /// Lets go of the graph until the next call of convert(), which must come before a call of
    /// patch(). Arrays and images are kept if they have not changed by then.
    void releaseGraph();

    /// Makes the next conversion read all arrays and images again, whatever their modified counts
    /// say.
    void forget();

private:
    struct Implementation;
    std::unique_ptr<Implementation> _implementation;
};

} // namespace osgRayTrace::engine
