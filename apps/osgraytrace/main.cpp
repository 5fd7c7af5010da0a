// main.cpp - osgraytrace: ray traces models to files, without any OpenGL context. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Camera.h"
#include "Options.h"
#include "Picture.h"
#include "PictureFile.h"
#include "Progress.h"
#include "Reference.h"
#include "StatisticsText.h"
#include "apps/common/DrawnParts.h"
#include "apps/common/ErrorMeasures.h"
#include "apps/common/Interruption.h"
#include "apps/common/ModelFiles.h"
#include "apps/common/Output.h"
#include "apps/common/PluginPath.h"
#include "apps/common/Program.h"
#include "apps/common/SceneNames.h"
#include "apps/common/StoredScene.h"

#include <osgRayTrace/MaterialFile>

#include <osgGA/EventVisitor>
#include <osgViewer/Viewer>

#include <cstdio>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace::app
{

namespace
{

constexpr const char* kProgram = "osgraytrace";

/// Returns one sentence that names what the picture lacks without OpenGL; empty if it lacks
/// nothing.
std::string missingParts(const Options& options, const Statistics& statistics)
{
    if (options.context != Context::None) return {};
    const std::string parts = inWords(drawnParts(statistics));
    return parts.empty() ? parts
                         : "left out without OpenGL: " + parts + "; --context egl draws them";
}

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
    {
        const std::string missing = missingParts(options, picture.statistics);
        throw Failure(kCannotRender, "the scene holds no triangles to render" +
                                         (missing.empty() ? missing : "; " + missing));
    }
    return picture;
}

/// Brings the scene to the state of osgviewer's first frame before it is drawn: slides are chosen,
/// skeletons are posed, clocks are set.
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

/// Takes the settings of the scene; those of the command line win. Throws Failure(kCannotLoad).
void takeSettingsOf(osg::Node& scene, Options& options)
{
    const osg::ref_ptr<RayTracedScene> stored = storedScene(scene);
    if (!stored) return;
    takeStoredSettings(*stored->getSettings(), options);
    const std::string error = options.settings->getMaterialsError();
    if (!error.empty()) throw Failure(kCannotLoad, "materials of the scene: " + error);
}

void printMeasures(const ErrorMeasures& measures)
{
    std::printf("RMSE %.6g\nrelMSE %.6g\nmean ratio %.6g\n", measures.rmse, measures.relMse,
                measures.meanRatio);
}

/// Says how much of the picture a signal has left.
void reportInterruption(const Options& options, const Statistics& statistics)
{
    std::string left = std::to_string(statistics.passes) + " of at most " +
                       std::to_string(options.settings->getMaxPasses()) + " passes are written";
    if (statistics.passes == 0)
    {
        const int percent = static_cast<int>(100.0 * statistics.imageShare);
        left = "not even the first pass was complete: " + std::to_string(percent) +
               " % of the picture is written, the rest of it is background";
    }
    std::cerr << "osgraytrace: " << interruptionName() << ": " << left << '\n';
}

/// Returns the outputs that a picture of this size can be written to. The others are reported, and
/// recorded in code.
std::vector<std::string> writableOutputs(const Options& options, int& code)
{
    std::vector<std::string> writable;
    for (const std::string& output : options.outputs)
    {
        const std::string problem = whyNotInFile(output, options.width, options.height);
        if (problem.empty())
            writable.push_back(output);
        else
            code = reportFailure(kProgram, cannotWrite(output, problem));
    }
    return writable;
}

/// Writes all that can be written, whatever else fails.
int writeAll(const Options& options, const std::vector<std::string>& outputs,
             const Picture& picture, const std::optional<ErrorMeasures>& measures)
{
    int code = kDone;
    const auto attempt = [&code](const auto& write)
    {
        try
        {
            write();
        }
        catch (const Failure& failure)
        {
            code = reportFailure(kProgram, failure);
        }
    };
    for (const std::string& output : outputs)
    {
        attempt([&] { writePicture(output, picture); });
    }
    if (!options.statistics.empty())
    {
        const std::string text = statisticsJson(options, picture.statistics, measures);
        attempt([&] { writeText(options.statistics, text); });
    }
    return code;
}

int run(Options options)
{
    // Steps that can fail without rendering come first.
    std::vector<Output> files;
    for (const std::string& output : options.outputs)
    {
        files.push_back({"-o", output});
    }
    if (!options.statistics.empty()) files.push_back({"--stats", options.statistics});
    checkOutputs(files);
    int code = kDone;
    const std::vector<std::string> outputs = writableOutputs(options, code);
    if (outputs.empty() && options.statistics.empty() && !options.report) return code;
    const std::string materialsError = options.settings->getMaterialsError();
    if (!materialsError.empty()) throw Failure(kCannotLoad, "--materials " + materialsError);
    osg::ref_ptr<osg::Image> reference;
    if (!options.reference.empty())
        reference = readReference(options.reference, options.width, options.height);
    const osg::ref_ptr<osg::Node> scene = readScene(options.models);
    takeSettingsOf(*scene, options);
    goToFirstFrame(*scene);

    const OrderlyEnd end; // from here on there are results to write
    const Picture picture = render(options, *scene);
    std::optional<ErrorMeasures> measures;
    if (reference) measures = errorMeasures(*picture.radiance, *reference);

    const int written = writeAll(options, outputs, picture, measures);
    std::puts(statisticsLine(options, picture.statistics, *picture.radiance).c_str());
    if (measures) printMeasures(*measures);
    const std::string missing = missingParts(options, picture.statistics);
    if (!missing.empty()) std::puts(missing.c_str());
    if (isInterrupted()) reportInterruption(options, picture.statistics);
    return written != kDone ? written : code;
}

/// Writes the materials of the models as a file to edit.
void writeMaterials(const Options& options)
{
    checkOutputs({{"--write-materials", options.writtenMaterials}});
    const MaterialFile file = materialFileOf(*readScene(options.models));
    writeText(options.writtenMaterials, file.text);
    std::cout << options.writtenMaterials << ": " << file.entries << " entries" << std::endl;
    if (file.nameless > 0)
        std::cerr << "osgraytrace: " << file.nameless
                  << " geometries are in no entry: neither material nor texture nor a node of "
                     "theirs alone has a name\n";
    if (!file.complete)
        std::cerr
            << "osgraytrace: the models are too large or too deep; materials of some parts are "
               "left out\n";
}

int runCommandLine(int argc, char** argv)
{
    const std::optional<Options> options = parseOptions(argc, argv);
    if (!options) return kDone;
    if (options->listOptions)
    {
        std::cout << optionTable();
        return kDone;
    }
    addPluginPath();
    if (options->names)
    {
        std::cout << namesOf(*readScene(options->models)) << std::flush;
        return kDone;
    }
    if (!options->writtenMaterials.empty())
    {
        writeMaterials(*options);
        return kDone;
    }
    return run(*options);
}

} // namespace

} // namespace osgRayTrace::app

int main(int argc, char** argv)
{
    using namespace osgRayTrace::app;
    return runProgram(kProgram, [=] { return runCommandLine(argc, argv); });
}
