// ShownPlacement.cpp - moves the manipulator of a view. Layer: apps.
// SPDX-License-Identifier: MIT
#include "ShownPlacement.h"

#include <osgGA/KeySwitchMatrixManipulator>

#include <algorithm>

namespace osgRayTrace::app
{

void showPlacement(const Placement& placement, osg::Node& scene, osgViewer::View& view)
{
    osgGA::CameraManipulator* manipulator = view.getCameraManipulator();
    if (!manipulator) return;
    auto* switched = dynamic_cast<osgGA::KeySwitchMatrixManipulator*>(manipulator);
    // The trackball turns around the scene's middle, or around the point of the line of sight
    // nearest to it.
    const osg::Vec3d sight = placement.center - placement.eye;
    const osg::Vec3d middle = scene.getBound().center();
    const double distance = std::max((middle - placement.eye) * sight, 1.0);
    manipulator->setHomePosition(placement.eye, placement.eye + sight * distance, placement.up);
    manipulator->setAutoComputeHomePosition(false);
    (switched ? switched->getCurrentMatrixManipulator() : manipulator)->home(0.0);

    osg::Camera& camera = *view.getCamera();
    const osg::Viewport* viewport = camera.getViewport();
    const double aspect = viewport && viewport->height() > 0.0 ? viewport->aspectRatio() : 1.25;
    const double top = placement.height / 2.0;
    if (top > 0.0)
        camera.setProjectionMatrixAsOrtho(-top * aspect, top * aspect, -top, top, 1.0, 10000.0);
    else
        camera.setProjectionMatrixAsPerspective(placement.fovyDegrees, aspect, 1.0, 10000.0);
}

} // namespace osgRayTrace::app
