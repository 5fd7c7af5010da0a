// Camera.h - the view of the scene and the background. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Options.h"
#include "apps/common/StoredView.h"

#include <osg/Matrixd>
#include <osg/Node>
#include <osg/Vec4>

namespace osgRayTrace::app
{

struct Camera
{
    osg::Matrixd view;
    osg::Matrixd projection;
    osg::Vec4 clearColor; ///< colour of the scene's first osg::ClearNode, or else osgViewer's
};

/// Returns the view that osgviewer opens with, for the scene as it is now.
Placement homePlacement(const Options& options, osg::Node& scene);

/// Returns the camera that the options name; without a name the first osg::CameraView of the scene,
/// or else home. Values of the options replace those of the view.
/// Near and far planes are those that osgviewer would compute from the scene's bound. Throws
/// Failure(kUsage) if the options define no view, or the scene has no camera of the name.
Camera cameraOf(const Options& options, osg::Node& scene, const Placement& home);

} // namespace osgRayTrace::app
