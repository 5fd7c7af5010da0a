// HomeView.cpp - the view that osgviewer opens a scene with. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/HomeView.h"

#include <osg/Camera>
#include <osgGA/TrackballManipulator>

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

constexpr double kViewerAspect = 1.25;   ///< of osgViewer's camera until there is a window
constexpr double kNearestShare = 1.0e-3; ///< of the distance: the nearest near plane
constexpr double kBoundMargin = 1.01;    ///< bounds are rounded

} // namespace

HomeView homeView(osg::Node& scene, double fovyDegrees, double aspect)
{
    const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setProjectionMatrixAsPerspective(fovyDegrees, kViewerAspect, 1.0, 10000.0);

    const osg::ref_ptr<osgGA::TrackballManipulator> manipulator = new osgGA::TrackballManipulator;
    manipulator->setNode(&scene);
    manipulator->computeHomePosition(camera);
    manipulator->setAutoComputeHomePosition(false); // home() would compute it without the camera
    manipulator->home(0.0);

    osg::Vec3d eye, center, up;
    manipulator->getHomePosition(eye, center, up);
    const double distance = (center - eye).length();
    const double radius = kBoundMargin * std::max(double(scene.getBound().radius()), 0.0);
    const double nearDistance = std::max(distance - radius, kNearestShare * distance);

    HomeView home;
    home.view = manipulator->getInverseMatrix();
    home.projection.makePerspective(fovyDegrees, aspect, nearDistance, distance + radius);
    return home;
}

} // namespace osgRayTrace::engine
