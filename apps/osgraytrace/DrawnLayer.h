// DrawnLayer.h - puts what OSG draws into a traced picture. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Camera.h"
#include "Picture.h"

#include <osgRayTrace/RayTracedScene>
#include <osgRayTrace/offscreen/FrameCapture>

#include <osgViewer/Viewer>

#include <functional>

namespace osgRayTrace::app
{

/// Holds a viewer whose camera has drawn a traced picture.
struct DrawnFrames
{
    osgViewer::Viewer& viewer;
    RayTracedScene& traced;
    osg::Node& scene; ///< the only child of traced
    FrameCapture& capture;
    std::function<void()> draw; ///< draws a frame, in which no time passes
};

/// Replaces the pixels of the picture in which OSG draws. The traced picture stays as it is while
/// OSG draws several frames, each shifted by a part of a pixel: as many as the settings allow
/// passes, up to 16, so that both have samples alike.
///
/// Display values are the means of these frames. A frame in which OSG has drawn a pixel counts for
/// the pixel's radiance with the linear value of its colour, and with alpha 1. In the channels, a
/// part that writes depth is its own first hit: depth, distance and position are those of the
/// depth buffer's 24 bits; normal, albedo and id are 0.
void compositeDrawnParts(const DrawnFrames& frames, const Camera& camera,
                         const RayTraceSettings& settings, Picture& picture);

} // namespace osgRayTrace::app
