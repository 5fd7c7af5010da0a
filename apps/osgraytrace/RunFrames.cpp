// RunFrames.cpp - renders the frames of an animation. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Particles.h"
#include "PictureFormat.h"
#include "Run.h"
#include "StatisticsText.h"
#include "Video.h"
#include "apps/common/ErrorLine.h"
#include "apps/common/Failure.h"
#include "apps/common/Interruption.h"
#include "apps/common/ModelFiles.h"
#include "apps/common/Output.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>

namespace osgRayTrace::app
{

namespace
{

/// Returns the options of one picture of an animation.
Options optionsOfFrame(const Options& options, int frame)
{
    Options one = options;
    one.at = frame / options.framesPerSecond;
    one.outputs.clear();
    for (const std::string& output : options.outputs)
        if (!isVideo(output)) one.outputs.push_back(*frameName(output, frame));
    if (!one.statistics.empty()) one.statistics = *frameName(one.statistics, frame);
    return one;
}

bool isThere(const Options& frame)
{
    std::vector<std::string> files = frame.outputs;
    if (!frame.statistics.empty()) files.push_back(frame.statistics);
    return std::all_of(files.begin(), files.end(),
                       [](const std::string& file) { return std::filesystem::exists(file); });
}

/// A scene on its way through the frames.
struct Animation
{
    explicit Animation(const Options& asked) : options(asked)
    {
        const osg::ref_ptr<osg::Node> scene = lit(readScene(asked.models), asked.lights);
        takeSettingsOf(*scene, options);
        shown = std::make_unique<TimedScene>(options, scene);
        // Particles depend on all frames before; all else that moves, on the time.
        isForOneFrame = options.context != Context::None && hasParticles(*scene);
    }

    Options options; ///< with the settings of the scene
    std::unique_ptr<TimedScene> shown;
    bool isForOneFrame = false;
};

/// Renders one picture of an animation, and writes it unless a signal came meanwhile. Returns
/// whether it is written. video: takes the frame as well; null: there is none.
bool runFrame(const Options& options, int frame, TimedScene& shown, Video* video)
{
    const Picture picture = render(options, shown);
    if (isInterrupted()) return false;
    const int written = writeAll(options, options.outputs, picture, {});
    if (video) video->add(*picture.display);
    std::printf("frame %d: %s\n", frame,
                statisticsLine(options, picture.statistics, *picture.radiance).c_str());
    std::fflush(stdout);
    if (written != kDone) throw Failure(written, "the frames after it are not rendered");
    return true;
}

/// Renders all frames that are wanted, till a signal comes.
void renderFrames(const Options& options, Video* video)
{
    std::optional<Animation> animation;
    for (int number = options.frames->first; number <= options.frames->last; ++number)
    {
        if (options.skipsExisting && isThere(optionsOfFrame(options, number))) continue;
        if (!animation || animation->isForOneFrame) animation.emplace(options);
        const Options frame = optionsOfFrame(animation->options, number);
        const bool written = runFrame(frame, number, *animation->shown, video);
        if (!isInterrupted()) continue;
        printError(kProgram, interruptionName() + ": frame " +
                                 std::to_string(written ? number + 1 : number) +
                                 " and those after it are not written");
        break;
    }
}

/// Renders all frames, also into a video, which appears when it is whole.
void renderVideo(const Options& options, const std::string& path)
{
    std::exception_ptr failure; // of other files
    const auto write = [&](const std::string& file)
    {
        Video video(path, file, options.framesPerSecond);
        try
        {
            renderFrames(options, &video);
        }
        catch (const Failure&)
        {
            failure = std::current_exception();
            throw;
        }
        video.finish();
    };
    try
    {
        writeOutput(path, write);
    }
    catch (const Failure&)
    {
        if (failure) std::rethrow_exception(failure);
        if (!isInterrupted()) throw; // else no frame was made in time
    }
}

} // namespace

int runFrames(const Options& options)
{
    Options first = optionsOfFrame(options, options.frames->first);
    for (const std::string& output : first.outputs)
    {
        const std::string problem = whyNotInFile(output, options.width, options.height);
        if (!problem.empty()) throw cannotWrite(output, problem);
    }
    const auto video = std::find_if(options.outputs.begin(), options.outputs.end(), isVideo);
    const bool hasVideo = video != options.outputs.end();
    if (hasVideo) first.outputs.push_back(*video);
    checkFiles(first);
    const OrderlyEnd end; // from here on there are frames to finish
    if (hasVideo)
        renderVideo(options, *video);
    else
        renderFrames(options, nullptr);
    return kDone;
}

} // namespace osgRayTrace::app
