// main.cpp - osgraytraceviewer: models, ray traced in a window. Layer: apps.
// SPDX-License-Identifier: MIT
#include "CaveViewer.h"
#include "KeyHandler.h"
#include "ReadableHelp.h"
#include "SettingsPanel.h"
#include "SignalledViewer.h"
#include "StatusLine.h"
#include "ViewerOptions.h"

#include "apps/common/ModelFiles.h"
#include "apps/common/PluginPath.h"
#include "apps/common/Program.h"
#include "apps/common/StoredScene.h"

#include <osgRayTrace/RayTracedScene>

#include <osg/ArgumentParser>
#include <osg/Group>
#include <osgDB/FileNameUtils>
#include <osgGA/StateSetManipulator>
#include <osgViewer/Viewer>
#include <osgViewer/ViewerEventHandlers>

#include <cstdlib>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

namespace osgRayTrace::app
{

namespace
{

const char* const kMaxPasses = "max-passes";
const char* const kPasses = "--passes"; ///< osgraytrace's name of the option

using Assignments = std::vector<std::pair<std::string, std::string>>;

void describe(osg::ApplicationUsage& usage)
{
    const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    usage.setApplicationName("osgraytraceviewer");
    usage.setDescription("Ray traces models in a window.");
    usage.setCommandLineUsage("osgraytraceviewer [options] MODEL [MODEL ...]");
    usage.addCommandLineOption("-h or --help", "Shows options and keys");
    usage.addCommandLineOption("--version", "Prints the version and exits");
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
        usage.addCommandLineOption(
            (option.name == kMaxPasses ? kPasses + std::string(" or ") : "") + "--" + option.name +
                " <" + option.range + ">",
            option.help, settings->get(option.name));
    describeView(usage);
    describeCave(usage);
}

/// Returns names and values of the settings on the command line. Throws Failure(kUsage).
Assignments readSettings(osg::ArgumentParser& arguments)
{
    Assignments assignments;
    osg::ref_ptr<RayTraceSettings> trial = new RayTraceSettings;
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
    {
        const auto readAll = [&](const std::string& argument, const std::string& name)
        {
            std::string value;
            while (arguments.read(argument, value))
            {
                assignments.emplace_back(option.name, value);
                if (trial->set(name, value)) continue;
                throw Failure(kUsage, "--" + option.name + " " + value + ": the values are " +
                                          option.range);
            }
        };
        if (!option.formerName.empty()) readAll("--" + option.formerName, option.formerName);
        readAll("--" + option.name, option.name);
        if (option.name == kMaxPasses) readAll(kPasses, option.name);
    }
    return assignments;
}

std::vector<std::string> modelNames(osg::ArgumentParser& arguments)
{
    std::vector<std::string> names;
    for (int i = 1; i < arguments.argc(); ++i)
        if (!arguments.isOption(i)) names.push_back(arguments[i]);
    return names;
}

/// What is shown over the picture and reacts to keys and the mouse.
struct Handlers
{
    explicit Handlers(RayTracedScene* scene)
        : keys(new KeyHandler(scene)),
          statusLine(new StatusLine(scene, keys.get())),
          panel(new SettingsPanel(scene))
    {
    }

    osg::ref_ptr<KeyHandler> keys;
    osg::ref_ptr<StatusLine> statusLine;
    osg::ref_ptr<SettingsPanel> panel;
};

/// Keeps the backdrop's image in proportion as the window changes its size.
class BackdropHandler : public osgGA::GUIEventHandler
{
public:
    BackdropHandler(osg::Camera* camera, Backdrop backdrop)
        : _camera(camera), _backdrop(std::move(backdrop))
    {
    }

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override
    {
        const auto* view = dynamic_cast<osgViewer::View*>(&action);
        const osg::Viewport* viewport = view ? view->getCamera()->getViewport() : nullptr;
        if (event.getEventType() != osgGA::GUIEventAdapter::FRAME || !viewport) return false;
        const double aspect = viewport->aspectRatio();
        if (aspect > 0.0 && aspect != _aspect) fitBackdrop(*_camera, _backdrop, aspect);
        _aspect = aspect;
        return false;
    }

private:
    osg::ref_ptr<osg::Camera> _camera;
    Backdrop _backdrop;
    double _aspect = 0.0;
};

void addHandlers(osgViewer::Viewer& viewer, const Handlers& handlers, osg::ApplicationUsage* usage)
{
    viewer.addEventHandler(handlers.panel.get()); // takes arrows while it is open
    viewer.addEventHandler(handlers.keys.get());
    viewer.addEventHandler(handlers.statusLine.get());
    viewer.addEventHandler(
        new osgGA::StateSetManipulator(viewer.getCamera()->getOrCreateStateSet()));
    viewer.addEventHandler(new osgViewer::ThreadingHandler);
    viewer.addEventHandler(new osgViewer::WindowSizeHandler);
    viewer.addEventHandler(new osgViewer::StatsHandler);
    viewer.addEventHandler(new osgViewer::LODScaleHandler);
    viewer.addEventHandler(new osgViewer::RecordCameraPathHandler);
    viewer.addEventHandler(new ReadableHelp(usage));
}

/// Returns the title of the window: "cow.osgt, glider.osgt".
std::string titleOf(const std::vector<std::string>& models)
{
    std::string title;
    for (const std::string& model : models)
        title += (title.empty() ? "" : ", ") + osgDB::getSimpleFileName(model);
    return title;
}

/// Holds models with the ray traced scene that they are in.
struct Models
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<RayTracedScene> scene;
};

/// Returns the models below a ray traced scene. Throws Failure(kCannotLoad).
Models readModels(const std::vector<std::string>& names, const Assignments& assignments)
{
    Models models;
    models.root->addChild(readScene(names).get());
    models.scene = storedScene(*models.root); // cow.osgt.raytrace
    if (!models.scene)
    {
        models.scene = new RayTracedScene;
        models.scene->addChild(models.root.get());
        models.root = new osg::Group;
        models.root->addChild(models.scene.get());
    }
    for (const auto& [name, value] : assignments)
        models.scene->getSettings()->set(name, value);
    const std::string materialsError = models.scene->getSettings()->getMaterialsError();
    if (!materialsError.empty()) throw Failure(kCannotLoad, "--materials " + materialsError);
    return models;
}

/// Adds the settings with which the walls of a CAVE show one picture, unless the environment or the
/// command line wants otherwise.
Assignments wallSettings(Assignments assignments)
{
    if (!std::getenv("OSGRAYTRACE_EQUAL_VIEWS"))
        assignments.insert(assignments.begin(), {"equal-views", "true"});
    return assignments;
}

int show(osgViewer::Viewer& viewer, const Models& models, const std::string& title,
         const ViewerOptions& options, osg::ApplicationUsage* usage)
{
    const auto& [root, scene] = models;
    const std::string problem = options.lights.addTo(*scene);
    if (!problem.empty()) throw Failure(kCannotLoad, problem);
    const Handlers handlers(scene.get());
    root->addChild(handlers.statusLine->camera());
    root->addChild(handlers.panel->camera());
    if (options.backdrop.wanted)
    {
        const osg::ref_ptr<osg::Camera> behind = backdropCamera(options.backdrop, 1280.0 / 1024.0);
        root->addChild(behind);
        viewer.addEventHandler(new BackdropHandler(behind, options.backdrop));
    }

    viewer.setSceneData(root.get());
    addManipulators(viewer, options);
    if (const auto color = storedClearColor(*root)) viewer.getCamera()->setClearColor(*color);
    if (options.backdrop.wanted) // fog before the backdrop is not mixed with the clear colour
    {
        osg::Vec4 color = viewer.getCamera()->getClearColor();
        color.a() = 0.0f;
        viewer.getCamera()->setClearColor(color);
    }
    showView(viewer, *root, options);
    viewer.getCamera()->addFinalDrawCallback(handlers.keys->windowPicture());
    addHandlers(viewer, handlers, usage);
    viewer.realize();
    osgViewer::Viewer::Windows windows;
    viewer.getWindows(windows);
    if (windows.empty()) throw Failure(kCannotRender, "cannot open a window");
    for (osgViewer::GraphicsWindow* window : windows)
        window->setWindowName(title);
    return viewer.run();
}

int run(int argc, char** argv)
{
    addPluginPath();
    osg::ArgumentParser arguments(&argc, argv);
    osg::ApplicationUsage& usage = *arguments.getApplicationUsage();
    describe(usage);

    if (arguments.read("--version"))
    {
        std::cout << versionText("osgraytraceviewer") << '\n';
        return kDone;
    }
    const bool help = arguments.read("-h") || arguments.read("--help");
    const Assignments assignments = readSettings(arguments);
    const CaveOptions cave = readCaveOptions(arguments);
    const ViewerOptions view = readViewerOptions(arguments);
    SignalledViewer viewer(arguments);
    if (help)
    {
        osg::ref_ptr<RayTracedScene> none = new RayTracedScene;
        addManipulators(viewer, view);
        addHandlers(viewer, Handlers(none.get()), &usage);
        viewer.getUsage(usage);
        usage.write(std::cout, osg::ApplicationUsage::COMMAND_LINE_OPTION |
                                   osg::ApplicationUsage::KEYBOARD_MOUSE_BINDING);
        return kDone;
    }
    arguments.reportRemainingOptionsAsUnrecognized();
    if (arguments.errors())
    {
        arguments.writeErrorMessages(std::cerr);
        return kUsage;
    }
    if (!cave.file.empty() && view.backdrop.wanted)
        throw Failure(kUsage, "--cave excludes --background");
    const std::vector<std::string> names = modelNames(arguments);
    if (names.empty()) throw Failure(kUsage, "no MODEL given; --help shows options and keys");
    const Models models =
        readModels(names, cave.file.empty() ? assignments : wallSettings(assignments));
    const std::string title = titleOf(names);
    if (!cave.file.empty()) return runCave(cave, models.root.get(), models.scene.get(), title);
    return show(viewer, models, title, view, &usage);
}

} // namespace

} // namespace osgRayTrace::app

int main(int argc, char** argv)
{
    using namespace osgRayTrace::app;
    return runProgram("osgraytraceviewer", [=]() mutable { return run(argc, argv); });
}
