// RunPicture.cpp - renders a picture and writes it. Layer: apps.
// SPDX-License-Identifier: MIT
#include "PictureFile.h"
#include "PictureTexts.h"
#include "Reference.h"
#include "Run.h"
#include "StatisticsText.h"
#include "apps/common/DrawnParts.h"
#include "apps/common/ErrorLine.h"
#include "apps/common/Interruption.h"
#include "apps/common/ModelFiles.h"
#include "apps/common/Output.h"
#include "apps/common/Program.h"
#include "apps/common/StoredScene.h"

#include <cstdio>
#include <iostream>

namespace osgRayTrace::app
{

namespace
{

/// Returns one sentence that names what the picture lacks without OpenGL; empty if it lacks
/// nothing.
std::string missingParts(const Options& options, const Statistics& statistics)
{
    if (options.context != Context::None) return {};
    const std::string parts = inWords(drawnParts(statistics));
    return parts.empty() ? parts
                         : "left out without OpenGL: " + parts + "; --context egl draws them";
}

/// Puts the backdrop of the options behind a picture that OpenGL has put before its clear colour.
void placeBackdrop(const Options& options, const osg::Vec4& clearColor, Picture& picture)
{
    if (!options.backdrop.wanted || options.context == Context::None) return;
    if (options.backdrop.transparent)
        picture.straight = new osg::Image(*picture.display, osg::CopyOp::DEEP_COPY_ALL);
    putBehind(options.backdrop, *picture.radiance, clearColor, windowOf(options),
              picture.straight ? *picture.straight : *picture.display);
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
                       std::to_string(options.mostPasses()) + " passes are written";
    if (statistics.passes == 0)
    {
        const int percent = static_cast<int>(100.0 * statistics.imageShare);
        left = "not even the first pass was complete: " + std::to_string(percent) +
               " % of the picture is written, the rest of it is background";
    }
    if (!options.checkpoint.empty())
        left += "; the same command goes on from " + options.checkpoint;
    printError(kProgram, interruptionName() + ": " + left);
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

} // namespace

TimedScene::TimedScene(const Options& options, const osg::ref_ptr<osg::Node>& timed)
    : scene(timed), clock(*timed), home(homePlacement(options, *timed))
{
}

osg::ref_ptr<osg::Node> lit(const osg::ref_ptr<osg::Node>& scene, const SceneLights& lights)
{
    if (!lights.any()) return scene;
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(scene);
    const std::string problem = lights.addTo(*group);
    if (!problem.empty()) throw Failure(kCannotLoad, problem);
    return group;
}

void checkMaterials(const Options& options)
{
    const std::string error = options.settings->getMaterialsError();
    if (!error.empty()) throw Failure(kCannotLoad, "--materials " + error);
}

void takeSettingsOf(osg::Node& scene, Options& options)
{
    const osg::ref_ptr<RayTracedScene> stored = storedScene(scene);
    if (!stored) return;
    takeStoredSettings(*stored->getSettings(), options);
    const std::string error = options.settings->getMaterialsError();
    if (!error.empty()) throw Failure(kCannotLoad, "materials of the scene: " + error);
}

Picture render(const Options& options, TimedScene& shown, Group* group)
{
    shown.clock.goTo(options.at);
    osg::Node& scene = *shown.scene;
    const Camera whole = cameraOf(options, scene, shown.home);
    Camera camera = whole;
    camera.projection = croppedProjection(options, whole.projection);
    Progress progress(options);
    Picture picture = group ? renderInGroup(options, shown, camera, progress, *group)
                      : options.context == Context::None
                          ? renderWithoutContext(options, shown, camera, progress)
                          : renderInContext(options, scene, camera, progress);
    placeBackdrop(options, camera.clearColor, picture);
    picture.texts = pictureTexts(options, whole, picture.statistics);
    if (options.report) std::cout << conversionReport(picture.statistics) << std::flush;
    const bool drawnByOsg =
        options.context != Context::None && partsDrawnByOsg(picture.statistics) > 0;
    if (!isTraced(picture.statistics) && !drawnByOsg)
    {
        const std::string missing = missingParts(options, picture.statistics);
        throw Failure(kCannotRender, "the scene holds no triangles to render" +
                                         (missing.empty() ? missing : "; " + missing));
    }
    return picture;
}

void checkFiles(const Options& options)
{
    std::vector<Output> files;
    for (const std::string& output : options.outputs)
        files.push_back({"-o", output});
    if (!options.statistics.empty()) files.push_back({"--stats", options.statistics});
    if (!options.checkpoint.empty()) files.push_back({"--checkpoint", options.checkpoint});
    checkOutputs(files);
}

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

int runPicture(Options options, Group* group)
{
    // Steps that can fail without rendering come first.
    checkFiles(options);
    int code = kDone;
    const std::vector<std::string> outputs = writableOutputs(options, code);
    if (outputs.empty() && options.statistics.empty() && !options.report &&
        options.checkpoint.empty())
        return code;
    osg::ref_ptr<osg::Image> reference;
    if (!options.reference.empty())
        reference = readReference(options.reference, options.width, options.height);
    const osg::ref_ptr<osg::Node> scene = lit(readScene(options.models), options.lights);
    takeSettingsOf(*scene, options);
    TimedScene shown(options, scene);

    const OrderlyEnd end; // from here on there are results to write
    const Picture picture = render(options, shown, group);
    std::optional<ErrorMeasures> measures;
    if (reference) measures = errorMeasures(*picture.radiance, *reference);

    const int written = writeAll(options, outputs, picture, measures);
    std::puts(statisticsLine(options, picture.statistics, *picture.radiance).c_str());
    if (measures) printMeasures(*measures);
    const std::string missing = missingParts(options, picture.statistics);
    if (!missing.empty()) std::puts(missing.c_str());
    if (isInterrupted()) reportInterruption(options, picture.statistics);
    if (written != kDone) return written;
    return picture.code != kDone ? picture.code : code;
}

} // namespace osgRayTrace::app
