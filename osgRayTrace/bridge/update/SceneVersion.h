// SceneVersion.h - holds what update publishes and draw takes of a scene. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/view/ViewInputs.h"

#include <osgRayTrace/RayTraceSettings>

#include <osg/ref_ptr>

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

class PickIndex;
struct RasterizedPart; // see RasterizedParts.h

/// Holds what a draw thread needs to draw a view: the scene's inputs of views and the parts that
/// OSG draws. A published version is immutable: it stays what it is while update goes on.
struct SceneVersion
{
    ViewInputs inputs; ///< inputs of all views
    osg::ref_ptr<const RayTraceSettings> settings;
    /// OSG draws these parts itself. Null means that there is no scene, or none that can be traced.
    std::shared_ptr<const std::vector<RasterizedPart>> rasterized;
    /// Null means that nobody has picked since something came or went.
    std::shared_ptr<const PickIndex> pickIndex;
    bool paged = false; ///< see ConversionResult
    /// False: camera rays meet nothing, not even an environment. OSG draws all that is seen.
    bool seen = true;
};

} // namespace osgRayTrace::engine
