// Camera.cpp - places the camera. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Camera.h"

#include "apps/common/CameraPath.h"
#include "apps/common/Failure.h"

#include <filesystem>

namespace osgRayTrace::app
{

namespace
{

/// Returns the placement of the camera that the options name; nothing if they name none.
std::optional<Placement> chosenPlacement(const Options& options, osg::Node& scene,
                                         const Placement& home)
{
    if (options.camera.empty()) return std::nullopt;
    std::string names;
    for (const NamedPlacement& camera : namedPlacements(scene))
    {
        if (camera.name == options.camera) return camera.placement;
        names += (names.empty() ? "" : ", ") + camera.name;
    }
    if (std::filesystem::exists(options.camera))
        return withOptions(home, readViewFile(options.camera));
    throw Failure(kUsage, "--camera " + options.camera + ": the model's cameras are " +
                              (names.empty() ? "none" : names) + ", and there is no such file");
}

/// Returns where the turntable has a placement at the options' time.
Placement turnedPlacement(const Options& options, const Placement& placement, const Placement& home)
{
    if (options.turnFrames == 0) return placement;
    const double turns = options.at * options.framesPerSecond / options.turnFrames;
    return turned(placement, options.view.center.value_or(home.center),
                  options.view.up.value_or(home.up), 2.0 * osg::PI * turns);
}

} // namespace

Placement homePlacement(const Options& options, osg::Node& scene)
{
    const Crop whole = options.crop.value_or(Crop{0, 0, options.width, options.height});
    return homePlacement(scene, whole.fullWidth, whole.fullHeight,
                         options.view.fovyDegrees.value_or(kOsgViewerFovyDegrees));
}

Camera cameraOf(const Options& options, osg::Node& scene, const Placement& home)
{
    if (options.cameraPath)
    {
        const Placement place = placementOn(*options.cameraPath, options.at - options.afterFrame,
                                            options.afterFrame, kOsgViewerFovyDegrees);
        return cameraAt(withOptions(place, options.view), scene, options.aspect());
    }
    const std::optional<Placement> chosen = chosenPlacement(options, scene, home);
    const std::optional<Placement> stored = chosen ? chosen : storedPlacement(scene);
    const Placement placement = withOptions(stored.value_or(home), options.view);
    const std::string problem = whyNoView(placement, "--");
    if (!problem.empty()) throw Failure(kUsage, problem);
    return cameraAt(turnedPlacement(options, placement, home), scene, options.aspect());
}

osg::Matrixd croppedProjection(const Options& options, const osg::Matrixd& projection)
{
    if (!options.crop) return projection;
    const Crop& crop = *options.crop;
    const double sx = double(crop.fullWidth) / options.width;
    const double sy = double(crop.fullHeight) / options.height;
    const double middleX = (crop.left + options.width / 2.0) / crop.fullWidth;
    const double middleY = 1.0 - (crop.top + options.height / 2.0) / crop.fullHeight;
    return projection * osg::Matrixd::translate(1.0 - 2.0 * middleX, 1.0 - 2.0 * middleY, 0.0) *
           osg::Matrixd::scale(sx, sy, 1.0);
}

} // namespace osgRayTrace::app
