// Camera.h - from which side the scene is seen, and before which background. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Options.h"

#include <osg/Matrixd>
#include <osg/Node>
#include <osg/Vec4>

namespace osgRayTrace::app
{

struct Camera
{
    osg::Matrixd view;
    osg::Matrixd projection;
    osg::Vec4 clearColor; ///< of the scene's first osg::ClearNode, or else osgViewer's
};

/// The first osg::CameraView of the scene, or else the view that osgviewer opens with; what the
/// options state replaces it. Near and far planes are those that osgviewer would compute from the
/// scene's bound. Throws Failure(kUsage) if the options define no view.
Camera cameraOf(const Options& options, osg::Node& scene);

} // namespace osgRayTrace::app
