// PlacedCamera.h - matrices of a placement in a scene. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "StoredView.h"

#include <osg/Matrixd>
#include <osg/Node>
#include <osg/Vec4>

#include <string>

namespace osgRayTrace::app
{

constexpr double kOsgViewerFovyDegrees =
    29.148431; ///< osgViewer's default display settings [degrees]

struct Camera
{
    osg::Matrixd view;
    osg::Matrixd projection;
    osg::Vec4 clearColor; ///< colour of the scene's first osg::ClearNode, or else osgViewer's
};

/// Returns the view that osgviewer opens with, for the scene as it is now.
Placement homePlacement(osg::Node& scene, int width, int height, double fovyDegrees);

/// Returns why nothing can be seen from a placement: "--up is zero or along the line of sight". The
/// names are prefixed, so that users find their own words; empty: it can be used.
std::string whyNoView(const Placement& placement, const std::string& prefix);

/// Returns the camera of a placement; aspect: width by height. Near and far planes are those that
/// osgviewer would compute from the scene's bound.
Camera cameraAt(const Placement& placement, osg::Node& scene, double aspect);

} // namespace osgRayTrace::app
