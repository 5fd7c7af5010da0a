// HomeView.cpp - the view that osgviewer opens a scene with. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/HomeView.h"

#include <osg/Camera>
#include <osg/ComputeBoundsVisitor>
#include <osgGA/TrackballManipulator>

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

constexpr double kViewerAspect = 1.25;   ///< aspect of osgViewer's camera until there is a window
constexpr double kNearestShare = 1.0e-3; ///< nearest near plane, as a share of the distance
constexpr double kBoundMargin = 1.01;    ///< margin for the rounding of bounds

/// Returns how far drawables reach from a point. The bounds of nodes may be stored, and be smaller
/// than their content.
double reachOf(osg::Node& scene, const osg::Vec3d& center)
{
    osg::ComputeBoundsVisitor drawables;
    scene.accept(drawables);
    const osg::BoundingBox& box = drawables.getBoundingBox();
    double reach = 0.0;
    for (unsigned int i = 0; i < 8 && box.valid(); ++i)
        reach = std::max(reach, (osg::Vec3d(box.corner(i)) - center).length());
    return reach;
}

} // namespace

HomeView homeView(osg::Node& scene, double fovyDegrees, double aspect)
{
    const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setProjectionMatrixAsPerspective(fovyDegrees, kViewerAspect, 1.0, 10000.0);

    const osg::ref_ptr<osgGA::TrackballManipulator> manipulator = new osgGA::TrackballManipulator;
    manipulator->setNode(&scene);
    manipulator->computeHomePosition(camera);
    // Otherwise home() would compute it without the camera.
    manipulator->setAutoComputeHomePosition(false);
    manipulator->home(0.0);

    osg::Vec3d eye, center, up;
    manipulator->getHomePosition(eye, center, up);
    const double distance = (center - eye).length();
    HomeView home;
    home.view = manipulator->getInverseMatrix();
    const double radius =
        kBoundMargin * std::max({double(scene.getBound().radius()), reachOf(scene, center), 0.0});
    const double nearDistance = std::max(distance - radius, kNearestShare * distance);
    home.projection.makePerspective(fovyDegrees, aspect, nearDistance, distance + radius);
    return home;
}

} // namespace osgRayTrace::engine
