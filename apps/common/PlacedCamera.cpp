// PlacedCamera.cpp - places cameras as osgviewer does. Layer: apps.
// SPDX-License-Identifier: MIT
#include "PlacedCamera.h"

#include <osgRayTrace/Renderer>

#include <osg/ComputeBoundsVisitor>

#include <algorithm>

namespace osgRayTrace::app
{

namespace
{

const osg::Vec4 kOsgViewerClearColor(0.2f, 0.2f, 0.4f, 1.0f);
constexpr double kNearFarRatio = 0.0005; ///< default of osg::CullSettings

/// Holds distances from the eye along the line of sight.
struct DepthRange
{
    double nearest = 0.0, farthest = 0.0;
};

/// Returns the depths of the scene's bound, and of its drawables if these are larger: bounds may be
/// stored.
DepthRange depthsOf(osg::Node& scene, const osg::Matrixd& view)
{
    DepthRange range;
    const osg::BoundingSphere& bound = scene.getBound();
    if (!bound.valid()) return range;
    const double depth = -(osg::Vec3d(bound.center()) * view).z();
    range = {depth - bound.radius(), depth + bound.radius()};
    osg::ComputeBoundsVisitor drawables;
    scene.accept(drawables);
    if (!drawables.getBoundingBox().valid()) return range;
    for (unsigned int i = 0; i < 8; ++i)
    {
        const double corner = -(osg::Vec3d(drawables.getBoundingBox().corner(i)) * view).z();
        range = {std::min(range.nearest, corner), std::max(range.farthest, corner)};
    }
    return range;
}

osg::Matrixd projectionOf(const Placement& placement, double aspect, const DepthRange& depths)
{
    const double zFar = depths.farthest > 0.0 ? depths.farthest * 1.001 : 1.0;
    const double zNear = std::max(depths.nearest * 0.999, zFar * kNearFarRatio);
    const double top = placement.height / 2.0;
    if (top > 0.0) return osg::Matrixd::ortho(-top * aspect, top * aspect, -top, top, zNear, zFar);
    return osg::Matrixd::perspective(placement.fovyDegrees, aspect, zNear, zFar);
}

} // namespace

Placement homePlacement(osg::Node& scene, int width, int height, double fovyDegrees)
{
    Placement placement;
    placement.fovyDegrees = fovyDegrees;
    osg::ref_ptr<Renderer> renderer = new Renderer;
    renderer->setScene(&scene);
    renderer->setSize(width, height);
    renderer->setHomeView(placement.fovyDegrees);

    const osg::BoundingSphere& bound = scene.getBound();
    const osg::Matrixd view = renderer->getViewMatrix();
    const double distance = bound.valid() ? -(osg::Vec3d(bound.center()) * view).z() : 1.0;
    view.getLookAt(placement.eye, placement.center, placement.up, distance);
    return placement;
}

std::string whyNoView(const Placement& placement, const std::string& prefix)
{
    if ((placement.center - placement.eye).length2() == 0.0)
        return prefix + "eye and " + prefix + "center are the same point";
    if (((placement.center - placement.eye) ^ placement.up).length2() == 0.0)
        return prefix + "up is zero or along the line of sight";
    return "";
}

Camera cameraAt(const Placement& placement, osg::Node& scene, double aspect)
{
    Camera camera;
    camera.clearColor = storedClearColor(scene).value_or(kOsgViewerClearColor);
    camera.view = osg::Matrixd::lookAt(placement.eye, placement.center, placement.up);
    camera.projection = projectionOf(placement, aspect, depthsOf(scene, camera.view));
    return camera;
}

} // namespace osgRayTrace::app
