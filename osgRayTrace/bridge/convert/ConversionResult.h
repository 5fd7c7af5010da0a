// ConversionResult.h - what a conversion makes of a scene graph. Layer: bridge.
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
    ConversionPaths paths; ///< of what is counted, the first few
    /// For OSG to draw; null if nothing is, or ConversionInput::rasterizesRest is not set.
    std::shared_ptr<const RasterizedParts> rasterized;
    std::shared_ptr<const PickIndex> pickIndex; ///< null unless ConversionInput::picks
    bool paged = false; ///< parts of the graph are files that are read when they are seen
    /// Of those in the scene: what was removed left them, and they hold nothing.
    std::size_t emptyInstances = 0, emptyMeshes = 0;
    double seconds = 0.0;
};

} // namespace osgRayTrace::engine
