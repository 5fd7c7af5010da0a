// Camera.h - the view of the scene that the options ask for. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Options.h"
#include "apps/common/PlacedCamera.h"

namespace osgRayTrace::app
{

/// Returns the view that osgviewer opens with, for the scene as it is now.
Placement homePlacement(const Options& options, osg::Node& scene);

/// Returns the camera that the options name; without a name the first osg::CameraView of the scene,
/// or else home. Values of the options replace those of the view, and a moving view is that of the
/// options' time.
/// Near and far planes are those that osgviewer would compute from the scene's bound. Throws
/// Failure(kUsage) if the options define no view, or the scene has no camera of the name.
Camera cameraOf(const Options& options, osg::Node& scene, const Placement& home);

/// Returns the projection of the part of the picture that the options ask for.
osg::Matrixd croppedProjection(const Options& options, const osg::Matrixd& projection);

} // namespace osgRayTrace::app
