// Camera.cpp - places the camera. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Camera.h"

#include "apps/common/Failure.h"

#include <osgRayTrace/Renderer>

#include <osg/ComputeBoundsVisitor>

#include <algorithm>

namespace osgRayTrace::app
{

namespace
{

constexpr double kOsgViewerFovyDegrees =
    29.148431; ///< osgViewer's default display settings [degrees]
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

/// Returns the placement of the camera that the options name; nothing if they name none.
std::optional<Placement> chosenPlacement(const Options& options, osg::Node& scene)
{
    if (options.camera.empty()) return std::nullopt;
    std::string names;
    for (const NamedPlacement& camera : namedPlacements(scene))
    {
        if (camera.name == options.camera) return camera.placement;
        names += (names.empty() ? "" : ", ") + camera.name;
    }
    throw Failure(kUsage, "--camera " + options.camera + ": the model's cameras are " +
                              (names.empty() ? "none" : names));
}

} // namespace

Placement homePlacement(const Options& options, osg::Node& scene)
{
    Placement placement;
    placement.fovyDegrees = options.fovyDegrees.value_or(kOsgViewerFovyDegrees);
    osg::ref_ptr<Renderer> renderer = new Renderer;
    renderer->setScene(&scene);
    renderer->setSize(options.width, options.height);
    renderer->setHomeView(placement.fovyDegrees);

    const osg::BoundingSphere& bound = scene.getBound();
    const osg::Matrixd view = renderer->getViewMatrix();
    const double distance = bound.valid() ? -(osg::Vec3d(bound.center()) * view).z() : 1.0;
    view.getLookAt(placement.eye, placement.center, placement.up, distance);
    return placement;
}

Camera cameraOf(const Options& options, osg::Node& scene, const Placement& home)
{
    const double aspect = double(options.width) / options.height;
    const std::optional<Placement> chosen = chosenPlacement(options, scene);
    const std::optional<Placement> stored = chosen ? chosen : storedPlacement(scene);
    Placement placement = stored.value_or(home);
    placement.eye = options.eye.value_or(placement.eye);
    placement.center = options.center.value_or(placement.center);
    placement.up = options.up.value_or(placement.up);
    placement.fovyDegrees = options.fovyDegrees.value_or(placement.fovyDegrees);
    if (options.fovyDegrees) placement.height = 0.0;
    if ((placement.center - placement.eye).length2() == 0.0)
    {
        throw Failure(kUsage, "--eye and --center are the same point");
    }
    if (((placement.center - placement.eye) ^ placement.up).length2() == 0.0)
    {
        throw Failure(kUsage, "--up is zero or along the line of sight");
    }

    Camera camera;
    camera.clearColor = storedClearColor(scene).value_or(kOsgViewerClearColor);
    camera.view = osg::Matrixd::lookAt(placement.eye, placement.center, placement.up);
    camera.projection = projectionOf(placement, aspect, depthsOf(scene, camera.view));
    return camera;
}

} // namespace osgRayTrace::app
