// HomeView.h - the view that osgviewer opens a scene with. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Matrixd>
#include <osg/Node>

namespace osgRayTrace::engine
{

struct HomeView
{
    osg::Matrixd view;
    osg::Matrixd projection;
};

/// Returns the view that osgviewer begins with. The view matrix is the home position of osgGA's
/// trackball around the scene's bound, for the vertical field of view in degrees. As in osgviewer,
/// whose manipulator sees the projection before there is a window, the distance does not depend on
/// the image's shape: a narrow image cuts the scene at its sides. The projection is symmetric, with
/// width / height = aspect; its near and far planes enclose the scene's bound. Bounds of the graph
/// that are not known are computed.
HomeView homeView(osg::Node& scene, double fovyDegrees, double aspect);

} // namespace osgRayTrace::engine
