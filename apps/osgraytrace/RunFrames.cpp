// RunFrames.cpp - renders the frames of an animation. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Particles.h"
#include "PictureFormat.h"
#include "Run.h"
#include "SceneClock.h"
#include "StatisticsText.h"
#include "apps/common/Interruption.h"
#include "apps/common/ModelFiles.h"
#include "apps/common/Output.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
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
    for (std::string& output : one.outputs)
        output = *frameName(output, frame);
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

/// Renders one picture of an animation, and writes it unless a signal came meanwhile. Returns
/// whether it is written.
bool runFrame(const Options& options, int frame, osg::Node& scene, const Placement& home)
{
    const Picture picture = render(options, scene, home);
    if (isInterrupted()) return false;
    const int written = writeAll(options, options.outputs, picture, {});
    std::printf("frame %d: %s\n", frame,
                statisticsLine(options, picture.statistics, *picture.radiance).c_str());
    std::fflush(stdout);
    if (written != kDone) throw Failure(written, "the frames after it are not rendered");
    return true;
}

/// A scene on its way through the frames.
struct Animation
{
    explicit Animation(const Options& asked)
        : options(asked), scene(withLights(readScene(asked.models), asked.lights))
    {
        takeSettingsOf(*scene, options);
        clock = std::make_unique<SceneClock>(*scene);
        home = homePlacement(options, *scene);
        // Particles depend on all frames before; all else that moves, on the time.
        isForOneFrame = options.context != Context::None && hasParticles(*scene);
    }

    Options options; ///< with the settings of the scene
    osg::ref_ptr<osg::Node> scene;
    std::unique_ptr<SceneClock> clock;
    Placement home; ///< of the first frame: the view does not follow the scene's size
    bool isForOneFrame = false;
};

} // namespace

int runFrames(const Options& options)
{
    const Options first = optionsOfFrame(options, options.frames->first);
    checkFiles(first);
    for (const std::string& output : first.outputs)
    {
        const std::string problem = whyNotInFile(output, options.width, options.height);
        if (!problem.empty()) throw cannotWrite(output, problem);
    }
    const OrderlyEnd end; // from here on there are frames to finish
    std::optional<Animation> animation;
    for (int number = options.frames->first; number <= options.frames->last; ++number)
    {
        if (options.skipsExisting && isThere(optionsOfFrame(options, number))) continue;
        if (!animation || animation->isForOneFrame) animation.emplace(options);
        const Options frame = optionsOfFrame(animation->options, number);
        animation->clock->goTo(frame.at);
        const bool written = runFrame(frame, number, *animation->scene, animation->home);
        if (!isInterrupted()) continue;
        std::cerr << "osgraytrace: " << interruptionName() << ": frame "
                  << (written ? number + 1 : number) << " and those after it are not written\n";
        break;
    }
    return kDone;
}

} // namespace osgRayTrace::app
