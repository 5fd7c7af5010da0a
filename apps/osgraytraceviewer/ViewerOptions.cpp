// ViewerOptions.cpp - reads and applies the options of the viewer's view. Layer: apps.
// SPDX-License-Identifier: MIT
#include "ViewerOptions.h"

#include "ShownPlacement.h"

#include "apps/common/CameraPath.h"
#include "apps/common/Failure.h"
#include "apps/common/PlacedCamera.h"

#include <osgGA/AnimationPathManipulator>
#include <osgGA/DriveManipulator>
#include <osgGA/FirstPersonManipulator>
#include <osgGA/FlightManipulator>
#include <osgGA/KeySwitchMatrixManipulator>
#include <osgGA/OrbitManipulator>
#include <osgGA/TerrainManipulator>
#include <osgGA/TrackballManipulator>

#include <cmath>
#include <filesystem>

namespace osgRayTrace::app
{

namespace
{

/// Reads three numbers, if the option is there.
std::optional<osg::Vec3d> readVector(osg::ArgumentParser& arguments, const std::string& option)
{
    osg::Vec3d value;
    if (!arguments.read(option, value.x(), value.y(), value.z())) return std::nullopt;
    return value;
}

/// Reads a number above 0, if the option is there. Throws Failure(kUsage).
std::optional<double> readPositive(osg::ArgumentParser& arguments, const std::string& option,
                                   double below)
{
    double value = 0.0;
    if (!arguments.read(option, value)) return std::nullopt;
    if (value > 0.0 && value < below) return value;
    throw Failure(kUsage, option + " takes a number above 0" +
                              (below < HUGE_VAL ? " and below " + std::to_string(int(below)) : ""));
}

/// Returns the placement of the camera of the model that has the name; nothing if there is none.
std::optional<Placement> namedPlacement(osg::Node& scene, const std::string& name)
{
    for (const NamedPlacement& camera : namedPlacements(scene))
        if (camera.name == name) return camera.placement;
    return std::nullopt;
}

/// Reads the lights. Throws Failure(kUsage).
SceneLights readLights(osg::ArgumentParser& arguments)
{
    SceneLights lights;
    lights.readVariables(arguments.argc(), arguments.argv());
    std::string value, elevation;
    while (arguments.read("--sun", value, elevation))
        if (!lights.set("sun", value + ':' + elevation))
            throw Failure(kUsage, "--sun takes an azimuth and an elevation from -90 to 90 degrees");
    for (const char* name :
         {"environment", "environment-turn", "environment-strength", "headlight"})
        while (arguments.read(std::string("--") + name, value))
            if (!lights.set(name, value))
                throw Failure(kUsage, std::string("--") + name + " cannot be " + value);
    return lights;
}

} // namespace

void describeView(osg::ApplicationUsage& usage)
{
    usage.addCommandLineOption(
        "--camera <NAME|FILE>",
        "Camera of the model, by its name; or a file that key E has written");
    usage.addCommandLineOption("--eye <X Y Z>, --center <X Y Z>, --up <X Y Z>",
                               "Where the view begins, what it looks at, what is up");
    usage.addCommandLineOption("--fovy <DEGREES>", "Vertical field of view");
    usage.addCommandLineOption("--parallel <HEIGHT>",
                               "Parallel view that shows so much from bottom to top");
    usage.addCommandLineOption("--environment <FILE>",
                               "Image by longitude and latitude that lights the models");
    usage.addCommandLineOption("--environment-turn <DEGREES>",
                               "Turns it about +z, anticlockwise seen from above");
    usage.addCommandLineOption("--environment-strength <FACTOR>", "Factor of its radiance", "1");
    usage.addCommandLineOption(
        "--sun <AZIMUTH ELEVATION>",
        "Directional light: clockwise from +y, and above the horizon [degrees]");
    usage.addCommandLineOption("--headlight <on|off>",
                               "Light at the eye; on, unless a light is added");
    usage.addCommandLineOption("--background <FILE|COLOR[:COLOR]>",
                               "Stands behind the models: an image, a colour or two, each #rrggbb, "
                               "black, white or gray");
    usage.addCommandLineOption("-p <FILE.path>", "Plays a camera path that key z has recorded");
}

ViewerOptions readViewerOptions(osg::ArgumentParser& arguments)
{
    ViewerOptions options;
    options.lights = readLights(arguments);
    arguments.read("--camera", options.camera);
    options.view.eye = readVector(arguments, "--eye");
    options.view.center = readVector(arguments, "--center");
    options.view.up = readVector(arguments, "--up");
    options.view.fovyDegrees = readPositive(arguments, "--fovy", 180.0);
    options.view.height = readPositive(arguments, "--parallel", HUGE_VAL);
    std::string backdrop;
    if (arguments.read("--background", backdrop)) options.backdrop = readBackdrop(backdrop);
    if (options.backdrop.transparent) throw Failure(kUsage, "--background: a window is opaque");
    std::string path;
    if (!arguments.read("-p", path)) return options;
    options.path = readCameraPath(path);
    options.path->setLoopMode(osg::AnimationPath::LOOP);
    return options;
}

void addManipulators(osgViewer::Viewer& viewer, const ViewerOptions& options)
{
    const osg::ref_ptr<osgGA::KeySwitchMatrixManipulator> keys =
        new osgGA::KeySwitchMatrixManipulator;
    keys->addMatrixManipulator('1', "Trackball", new osgGA::TrackballManipulator);
    keys->addMatrixManipulator('2', "Flight", new osgGA::FlightManipulator);
    keys->addMatrixManipulator('3', "Drive", new osgGA::DriveManipulator);
    keys->addMatrixManipulator('4', "Terrain", new osgGA::TerrainManipulator);
    keys->addMatrixManipulator('5', "Orbit", new osgGA::OrbitManipulator);
    keys->addMatrixManipulator('6', "FirstPerson", new osgGA::FirstPersonManipulator);
    if (options.path)
        keys->addMatrixManipulator('8', "Path",
                                   new osgGA::AnimationPathManipulator(options.path.get()));
    if (options.path) keys->selectMatrixManipulator(keys->getNumMatrixManipulators() - 1);
    viewer.setCameraManipulator(keys.get());
}

void showView(osgViewer::Viewer& viewer, osg::Node& scene, const ViewerOptions& options)
{
    if (options.path) return;
    std::optional<Placement> placement = storedPlacement(scene);
    const Placement home = homePlacement(scene, 1280, 1024, kOsgViewerFovyDegrees);
    if (!options.camera.empty())
    {
        placement = namedPlacement(scene, options.camera);
        if (!placement && !std::filesystem::exists(options.camera))
            throw Failure(kUsage, "--camera " + options.camera +
                                      ": the model has no camera of this name, and there is no "
                                      "such file");
        if (!placement) placement = withOptions(home, readViewFile(options.camera));
    }
    if (!placement && !options.view.any()) return;
    const Placement shown = withOptions(placement.value_or(home), options.view);
    const std::string problem = whyNoView(shown, "--");
    if (!problem.empty()) throw Failure(kUsage, problem);
    showPlacement(shown, scene, viewer);
}

} // namespace osgRayTrace::app
