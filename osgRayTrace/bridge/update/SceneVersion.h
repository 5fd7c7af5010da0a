// SceneVersion.h - what update publishes and draw takes: a scene's inputs of views, and the OSG
// part. Layer: bridge.
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

/// What a draw thread needs to draw a view. Immutable: it stays what it is while update goes on.
struct SceneVersion
{
    ViewInputs inputs; ///< of all views
    osg::ref_ptr<const RayTraceSettings> settings;
    /// What OSG draws itself. Null: there is no scene, or none that can be traced.
    std::shared_ptr<const std::vector<RasterizedPart>> rasterized;
    /// Null: nobody has picked since something came or went.
    std::shared_ptr<const PickIndex> pickIndex;
    bool paged = false; ///< see ConversionResult
};

} // namespace osgRayTrace::engine
