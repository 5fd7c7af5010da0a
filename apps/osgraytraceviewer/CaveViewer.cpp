// CaveViewer.cpp - walls as slave cameras that follow the head. Layer: apps.
// SPDX-License-Identifier: MIT
#include "CaveViewer.h"
#include "KeyHandler.h"
#include "SignalledViewer.h"

#include "apps/cave/CaveView.h"
#include "apps/common/ErrorLine.h"
#include "apps/common/Failure.h"
#include "apps/common/ImageFile.h"
#include "apps/common/Output.h"

#include <osgRayTrace/offscreen/FrameCapture>
#include <osgRayTrace/offscreen/OffscreenContext>

#include <osg/ColorMask>
#include <osg/MatrixTransform>
#include <osgDB/FileNameUtils>
#include <osgViewer/ViewerEventHandlers>

#include <iostream>
#include <vector>

namespace osgRayTrace::app
{

namespace
{

/// This light is equal for all walls: a headlight would differ from wall to wall.
const osg::Vec4 kLightFrom(0.2f, -0.5f, 1.0f, 0.0f);

struct Rectangle
{
    int left = 0, bottom = 0, width = 0, height = 0;
};

/// Holds what one eye sees of one wall.
struct WallPicture
{
    const CaveWall* wall = nullptr;
    CaveEye eye = CaveEye::Centre;
    Rectangle place; ///< viewport in the window
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    osg::ref_ptr<FrameCapture> capture; ///< set for offscreen pictures
};

Rectangle placeOf(const CaveWall& wall, CaveEye eye)
{
    Rectangle place{wall.left, wall.bottom, wall.width, wall.height};
    if (wall.stereo == CaveStereo::LeftRight)
    {
        place.width = std::max(wall.width / 2, 1);
        if (eye == CaveEye::Right) place.left += place.width;
    }
    if (wall.stereo == CaveStereo::TopBottom)
    {
        place.height = std::max(wall.height / 2, 1);
        if (eye == CaveEye::Left) place.bottom += place.height;
    }
    return place;
}

std::vector<WallPicture> picturesOf(const CaveSetup& setup)
{
    std::vector<WallPicture> pictures;
    for (const CaveWall& wall : setup.walls)
    {
        const bool both = wall.stereo != CaveStereo::None;
        for (const CaveEye eye : both ? std::vector<CaveEye>{CaveEye::Left, CaveEye::Right}
                                      : std::vector<CaveEye>{wall.eye})
        {
            WallPicture picture;
            picture.wall = &wall;
            picture.eye = eye;
            picture.place = placeOf(wall, eye);
            pictures.push_back(picture);
        }
    }
    return pictures;
}

/// Lets the second picture on the same pixels leave those of the first.
void separateEyes(const WallPicture& picture, bool offscreen)
{
    if (offscreen) return;
    const bool left = picture.eye == CaveEye::Left;
    if (picture.wall->stereo == CaveStereo::QuadBuffer)
    {
        picture.camera->setDrawBuffer(left ? GL_BACK_LEFT : GL_BACK_RIGHT);
        picture.camera->setReadBuffer(left ? GL_BACK_LEFT : GL_BACK_RIGHT);
    }
    if (picture.wall->stereo == CaveStereo::Anaglyph)
    {
        picture.camera->getOrCreateStateSet()->setAttribute(
            new osg::ColorMask(left, !left, !left, true),
            osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
        picture.camera->setRenderOrder(osg::Camera::POST_RENDER, left ? 0 : 1);
        if (!left) picture.camera->setClearMask(GL_DEPTH_BUFFER_BIT);
    }
}

osg::ref_ptr<osg::GraphicsContext> windowContext(const CaveSetup& setup, const CaveWindow& window)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->readDISPLAY();
    traits->setUndefinedScreenDetailsToDefaultScreen();
    if (window.displayServer != 0 || window.displayScreen != 0)
    {
        traits->displayNum = window.displayServer;
        traits->screenNum = window.displayScreen;
    }
    unsigned int screenWidth = 0, screenHeight = 0;
    if (osg::GraphicsContext::WindowingSystemInterface* system =
            osg::GraphicsContext::getWindowingSystemInterface())
        system->getScreenResolution(*traits, screenWidth, screenHeight);
    traits->x = window.left;
    traits->y = std::max(static_cast<int>(screenHeight) - window.bottom - window.height, 0);
    traits->width = window.width;
    traits->height = window.height;
    traits->windowDecoration = window.decoration;
    traits->doubleBuffer = true;
    for (const CaveWall& wall : setup.walls)
        traits->quadBufferStereo |=
            &setup.windows[wall.window] == &window && wall.stereo == CaveStereo::QuadBuffer;
    traits->quadBufferStereo |= window.quadBuffer;
    return osg::GraphicsContext::createGraphicsContext(traits.get());
}

void openWindows(const CaveSetup& setup, std::vector<WallPicture>& pictures)
{
    std::vector<osg::ref_ptr<osg::GraphicsContext>> contexts(setup.windows.size());
    for (WallPicture& picture : pictures)
    {
        const auto index = static_cast<std::size_t>(picture.wall->window);
        if (!contexts[index]) contexts[index] = windowContext(setup, setup.windows[index]);
        if (!contexts[index])
            throw Failure(kCannotRender, "cannot open window " + std::to_string(index));
        picture.camera->setGraphicsContext(contexts[index].get());
        picture.camera->setViewport(picture.place.left, picture.place.bottom, picture.place.width,
                                    picture.place.height);
    }
}

void openOffscreen(std::vector<WallPicture>& pictures)
{
    for (WallPicture& picture : pictures)
    {
        const Rectangle& place = picture.place;
        const auto context = createOSMesaContext(place.width, place.height);
        if (!context) throw Failure(kCannotRender, "no OSMesa context for a wall");
        picture.capture = new FrameCapture;
        picture.camera->setGraphicsContext(context.get());
        picture.camera->setViewport(0, 0, place.width, place.height);
        picture.camera->addFinalDrawCallback(picture.capture.get());
    }
}

void addSlaves(osgViewer::Viewer& viewer, const CaveSetup& setup,
               const std::vector<WallPicture>& pictures, bool offscreen)
{
    for (const WallPicture& picture : pictures)
    {
        osg::Camera& camera = *picture.camera;
        camera.setName("wall " + std::to_string(picture.wall->index));
        camera.setReferenceFrame(osg::Transform::ABSOLUTE_RF); // its matrices are absolute
        camera.setNodeMask(0);                                 // hidden until moveHead has a view
        camera.setComputeNearFarMode(osg::Camera::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setClearColor(setup.background);
        separateEyes(picture, offscreen);
        viewer.addSlave(&camera, true);
    }
}

/// Moves the eyes. A wall that the eye is not before keeps its last picture, and has no picture
/// before it has seen the eye.
void moveHead(const CaveSetup& setup, const std::vector<WallPicture>& pictures,
              const CavePose& pose)
{
    const osg::Matrixd head = pose.matrix();
    for (const WallPicture& picture : pictures)
    {
        const auto view = caveView(setup, *picture.wall, picture.eye, head);
        if (!view) continue;
        picture.camera->setViewMatrix(view->view);
        picture.camera->setProjectionMatrix(view->projection);
        picture.camera->setNodeMask(~0u);
    }
}

/// Returns the model moved to the middle of the CAVE and scaled to the size that the configuration
/// wants.
osg::ref_ptr<osg::Node> fitted(osg::Node* root, double size)
{
    const osg::BoundingSphere bound = root->getBound();
    if (!(size > 0.0) || !(bound.radius() > 0.0f)) return root;
    const double scale = size / (2.0 * bound.radius());
    osg::ref_ptr<osg::MatrixTransform> transform =
        new osg::MatrixTransform(osg::Matrixd::translate(-osg::Vec3d(bound.center())) *
                                 osg::Matrixd::scale(scale, scale, scale));
    transform->addChild(root);
    return transform;
}

std::string fileOf(const std::string& output, const WallPicture& picture)
{
    std::string name =
        osgDB::getNameLessExtension(output) + '-' + std::to_string(picture.wall->index);
    if (picture.eye == CaveEye::Left) name += "-left";
    if (picture.eye == CaveEye::Right) name += "-right";
    const std::string extension = osgDB::getFileExtension(output);
    return name + '.' + (extension.empty() ? "png" : extension);
}

/// Returns the files of the pictures, one a wall, for walls that the head is before.
std::vector<Output> filesOf(const std::vector<WallPicture>& pictures, const std::string& output)
{
    std::vector<Output> files;
    for (const WallPicture& picture : pictures)
        if (picture.camera->getNodeMask() != 0)
            files.push_back({"--output", fileOf(output, picture)});
    return files;
}

void writePictures(osgViewer::Viewer& viewer, RayTracedScene& scene,
                   const std::vector<WallPicture>& pictures, const std::string& output)
{
    scene.getSettings()->setFrameBudget(0.0f); // nobody waits for a frame
    checkOutputs(filesOf(pictures, output));
    int passes = -1;
    while (!isInterrupted() && passes < scene.getSettings()->getMaxPasses())
    {
        viewer.frame();
        const Statistics statistics = scene.getDrawable()->getStatistics();
        if (!statistics.ok) throw Failure(kCannotRender, statistics.message);
        if (statistics.passes == passes) break; // nothing more to be seen
        passes = statistics.passes;
        if (isInterrupted()) break;
    }
    if (isInterrupted() && passes < 1)
        throw Failure(interruptionCode(), interruptionName() + ": there is no picture yet");
    if (isInterrupted())
        printError("osgraytraceviewer", interruptionName() + ": pictures of " +
                                            std::to_string(passes) + " passes are written");
    for (const WallPicture& picture : pictures)
    {
        if (picture.camera->getNodeMask() == 0)
        {
            printError("osgraytraceviewer",
                       "no picture of " + picture.camera->getName() + ": the head is behind it");
            continue;
        }
        const std::string file = fileOf(output, picture);
        writeImageFile(file, *picture.capture->getColorImage());
        std::cout << file << '\n';
    }
}

} // namespace

void describeCave(osg::ApplicationUsage& usage)
{
    usage.addCommandLineOption("--cave <file>",
                               "Shows the models on the walls of a CalVR configuration");
    usage.addCommandLineOption("--host <name>", "The host whose walls they are", "this one");
    usage.addCommandLineOption("--head <x y z h p r>",
                               "Place [mm] and angles [degrees] of the head");
    usage.addCommandLineOption("--head-path <file>",
                               "Moves the head: lines of seconds x y z h p r");
    usage.addCommandLineOption("--output <file.png>",
                               "Writes a picture a wall instead: file-0.png, ...");
    usage.addCommandLineOption("--time <seconds>", "Of the head path, for pictures", "0");
}

CaveOptions readCaveOptions(osg::ArgumentParser& arguments)
{
    CaveOptions options;
    options.host = caveHost();
    arguments.read("--cave", options.file);
    arguments.read("--host", options.host);
    arguments.read("--head-path", options.headPath);
    arguments.read("--output", options.output);
    arguments.read("--time", options.time);
    CavePose head;
    if (arguments.read("--head", head.position.x(), head.position.y(), head.position.z(), head.h,
                       head.p, head.r))
        options.head = head;
    const bool more = options.head || !options.headPath.empty() || !options.output.empty();
    if (options.file.empty() && more)
        throw Failure(kUsage, "--head, --head-path and --output need --cave");
    if (options.head && !options.headPath.empty())
        throw Failure(kUsage, "--head or --head-path, not both");
    return options;
}

int runCave(const CaveOptions& options, osg::Node* root, RayTracedScene* scene,
            const std::string& title)
{
    const CaveSetup setup = caveSetup(CaveFile(options.file, options.host));
    std::optional<HeadPath> path;
    if (!options.headPath.empty()) path = HeadPath::read(options.headPath);
    const bool offscreen = !options.output.empty();
    std::vector<WallPicture> pictures = picturesOf(setup);
    if (offscreen)
        openOffscreen(pictures);
    else
        openWindows(setup, pictures);

    SignalledViewer viewer;
    if (offscreen) viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer.setLightingMode(osg::View::SKY_LIGHT);
    viewer.getLight()->setPosition(kLightFrom);
    viewer.setSceneData(fitted(root, setup.sceneSize).get());
    addSlaves(viewer, setup, pictures, offscreen);
    const CavePose still = options.head.value_or(setup.head);
    moveHead(setup, pictures, path ? path->at(options.time) : still);
    viewer.realize();
    if (!viewer.isRealized()) throw Failure(kCannotRender, "cannot open the windows");
    osgViewer::Viewer::Windows windows;
    viewer.getWindows(windows);
    for (osgViewer::GraphicsWindow* window : windows)
        window->setWindowName(title);
    if (offscreen)
    {
        writePictures(viewer, *scene, pictures, options.output);
        return kDone;
    }

    const osg::ref_ptr<KeyHandler> keys = new KeyHandler(scene);
    viewer.addEventHandler(keys.get());
    viewer.addEventHandler(new osgViewer::StatsHandler);
    while (!viewer.done())
    {
        if (path && !keys->isFrozen()) moveHead(setup, pictures, path->at(viewer.elapsedTime()));
        viewer.frame();
    }
    return kDone;
}

} // namespace osgRayTrace::app
