// ConversionResult.h - the result of converting a scene graph. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/bridge/graph/RasterizedParts.h"
#include "osgRayTrace/scene/Scene.h"

#include <cstddef>
#include <memory>

namespace osgRayTrace::engine
{

class PickIndex;

struct ConversionResult
{
    std::shared_ptr<const Scene> scene; ///< never null
    ConversionCounts counts;
    ConversionPaths paths; ///< node paths of the first few counted objects
    /// Parts that OSG draws; null if there are none, or ConversionInput::rasterizesRest is not set.
    std::shared_ptr<const RasterizedParts> rasterized;
    std::shared_ptr<const PickIndex> pickIndex; ///< null unless ConversionInput::picks
    bool paged = false; ///< true: parts of the graph are files that are read when they are seen
    /// Numbers of instances and meshes in the scene that removed parts left, and that hold nothing.
    std::size_t emptyInstances = 0, emptyMeshes = 0;
    double seconds = 0.0;
};

} // namespace osgRayTrace::engine
