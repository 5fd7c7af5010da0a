// main.cpp - osgraytrace: ray traces models to files, without any OpenGL context. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Camera.h"
#include "Options.h"
#include "Output.h"
#include "Picture.h"
#include "Progress.h"
#include "Reference.h"
#include "StatisticsText.h"
#include "apps/common/DrawnParts.h"
#include "apps/common/ErrorMeasures.h"
#include "apps/common/Failure.h"
#include "apps/common/ModelFiles.h"
#include "apps/common/PluginPath.h"
#include "apps/common/StoredScene.h"

#include <osgGA/EventVisitor>
#include <osgViewer/Viewer>

#include <cstdio>
#include <exception>
#include <iostream>
#include <optional>

namespace osgRayTrace::app
{

namespace
{

Picture render(const Options& options, osg::Node& scene)
{
    const Camera camera = cameraOf(options, scene);
    Progress progress(options);
    Picture picture = options.context == Context::None
                          ? renderWithoutContext(options, scene, camera, progress)
                          : renderInContext(options, scene, camera, progress);
    if (options.report) std::cout << conversionReport(picture.statistics) << std::flush;
    const bool drawnByOsg =
        options.context != Context::None && partsDrawnByOsg(picture.statistics) > 0;
    if (picture.statistics.triangles == 0 && !drawnByOsg)
        throw Failure(kCannotRender, "the scene holds no triangles to render");
    return picture;
}

/// As osgviewer's first frame before it is drawn: slides are chosen, skeletons are posed, clocks
/// are set.
void goToFirstFrame(osg::Node& scene)
{
    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer.setSceneData(&scene);
    viewer.advance(0.0);
    viewer.getFrameStamp()->setReferenceTime(0.0); // equal pictures for any speed

    // Viewer::eventTraversal does nothing without a window.
    const osg::ref_ptr<osgGA::GUIEventAdapter> frame = new osgGA::GUIEventAdapter;
    frame->setEventType(osgGA::GUIEventAdapter::FRAME);
    frame->setTime(0.0);
    const osg::ref_ptr<osgGA::EventVisitor> events = new osgGA::EventVisitor;
    events->setActionAdapter(&viewer);
    events->setFrameStamp(viewer.getFrameStamp());
    events->setTraversalNumber(viewer.getFrameStamp()->getFrameNumber());
    events->addEvent(frame);
    scene.accept(*events);
    viewer.updateTraversal();
}

/// Those of the command line, over those of the scene. Throws Failure(kCannotLoad).
void takeSettingsOf(osg::Node& scene, Options& options)
{
    const osg::ref_ptr<RayTracedScene> stored = storedScene(scene);
    if (!stored) return;
    takeStoredSettings(*stored->getSettings(), options);
    const std::string error = options.settings->getMaterialsError();
    if (!error.empty()) throw Failure(kCannotLoad, "materials of the scene: " + error);
}

/// Radiance is that of what is ray traced alone.
void warnOfMissingParts(const std::string& output, const Options& options,
                        const Statistics& statistics)
{
    const uint64_t parts = partsDrawnByOsg(statistics);
    if (options.context == Context::None || parts == 0 || formatOf(output) != Format::Exr) return;
    std::cerr << "osgraytrace: " << output << " lacks " << parts
              << " parts of the scene that OpenGL draws: they are in .png and .jpg alone; --report "
                 "names them\n";
}

void printMeasures(const ErrorMeasures& measures)
{
    std::printf("RMSE %.6g\nrelMSE %.6g\nmean ratio %.6g\n", measures.rmse, measures.relMse,
                measures.meanRatio);
}

void run(Options options)
{
    // What can fail without rendering fails first.
    for (const std::string& output : options.outputs)
    {
        checkWritable(output);
    }
    if (!options.statistics.empty()) checkWritable(options.statistics);
    const std::string materialsError = options.settings->getMaterialsError();
    if (!materialsError.empty()) throw Failure(kCannotLoad, "--materials " + materialsError);
    osg::ref_ptr<osg::Image> reference;
    if (!options.reference.empty())
        reference = readReference(options.reference, options.width, options.height);
    const osg::ref_ptr<osg::Node> scene = readScene(options.models);
    takeSettingsOf(*scene, options);
    goToFirstFrame(*scene);

    const Picture picture = render(options, *scene);
    std::optional<ErrorMeasures> measures;
    if (reference) measures = errorMeasures(*picture.radiance, *reference);

    for (const std::string& output : options.outputs)
    {
        writePicture(output, picture);
        warnOfMissingParts(output, options, picture.statistics);
    }
    if (!options.statistics.empty())
    {
        writeText(options.statistics, statisticsJson(options, picture.statistics, measures));
    }
    std::puts(statisticsLine(options, picture.statistics, *picture.radiance).c_str());
    if (measures) printMeasures(*measures);
}

} // namespace

} // namespace osgRayTrace::app

int main(int argc, char** argv)
{
    using namespace osgRayTrace::app;
    try
    {
        const std::optional<Options> options = parseOptions(argc, argv);
        if (!options) return kDone;
        if (options->listOptions)
        {
            std::cout << optionTable();
            return kDone;
        }
        addPluginPath();
        run(*options);
        return kDone;
    }
    catch (const Failure& failure)
    {
        std::cerr << "osgraytrace: " << failure.what() << '\n';
        return failure.code();
    }
    catch (const std::exception& error)
    {
        std::cerr << "osgraytrace: " << error.what() << '\n';
        return kCannotRender;
    }
}
