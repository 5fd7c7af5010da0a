// MotionOptions.cpp - reads the options of times, frames and cameras that move. Layer: apps.
// SPDX-License-Identifier: MIT
#include "MotionOptions.h"

#include "NumberChecks.h"
#include "Video.h"
#include "apps/common/CameraPath.h"
#include "apps/common/Failure.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace osgRayTrace::app
{

namespace
{

constexpr int kMostTurnFrames = 1'000'000;

/// Returns all frames of a view that moves.
FrameRange allFrames(const Options& options)
{
    if (options.turnFrames != 0) return {0, std::abs(options.turnFrames) - 1};
    const double frames = options.cameraPath->getPeriod() * options.framesPerSecond;
    return {0, static_cast<int>(std::clamp(std::floor(frames + 1e-6), 0.0, 1e6))};
}

} // namespace

void addMotionOptions(CLI::App& app, Options& options, RawMotion& raw)
{
    app.add_option("--at", options.at,
                   "Time that the model is shown at: animations go on till then")
        ->option_text("SECONDS")
        ->check(between(-1e-300, 1e9, "a number from 0 on"));
    app.add_option("--frames", raw.frames,
                   "Frames of an animation, both included; -o and --stats then name the place of "
                   "the number: out.%04d.png")
        ->option_text("FIRST:LAST")
        ->excludes("--at");
    app.add_option("--fps", options.framesPerSecond, "Frames a second (25)")
        ->option_text("RATE")
        ->check(positive());
    app.add_flag("--skip-existing", options.skipsExisting,
                 "Leaves out the frames whose files are there");
    app.add_option("--camera-path", raw.cameraPath,
                   "Moves the camera as osgviewer has recorded it with z; without --frames and "
                   "--at: all frames of the path")
        ->option_text("FILE.path")
        ->excludes("--camera", "--eye", "--center", "--up");
    app.add_option("--turntable", options.turnFrames,
                   "Moves the camera around the centre once in so many frames, anticlockwise seen "
                   "from above if above 0; without --frames and --at: all of them")
        ->option_text("FRAMES")
        ->excludes("--camera-path")
        ->check(CLI::Range(-kMostTurnFrames, kMostTurnFrames));
    app.add_option("--shutter", options.shutter,
                   "Motion blur: the shutter is open for so long from the time of the picture on")
        ->option_text("SECONDS")
        ->check(between(-1e-300, 1e9, "a number from 0 on"));
}

void applyMotion(const CLI::App& app, const RawMotion& raw, Options& options)
{
    if (!raw.cameraPath.empty()) options.cameraPath = readCameraPath(raw.cameraPath);
    if (app.count("--turntable") && options.turnFrames == 0)
        throw Failure(kUsage, "--turntable 0: a turn has at least one frame");
    if (!raw.frames.empty())
    {
        options.frames = frameRangeOf(raw.frames);
        if (!options.frames)
            throw Failure(kUsage, "--frames " + raw.frames + ": is not FIRST:LAST, as 0:250");
    }
    const auto isNumbered = [](const std::string& output)
    { return isVideo(output) || frameName(output, 0).has_value(); };
    const bool hasFrames = std::any_of(options.outputs.begin(), options.outputs.end(), isNumbered);
    if (!options.frames && options.hasMovingView() && !app.count("--at") && hasFrames)
        options.frames = allFrames(options);
    if (app.count("--fps") && !options.frames && options.turnFrames == 0)
        throw Failure(kUsage, "--fps needs --frames");
    if (options.skipsExisting && !options.frames)
        throw Failure(kUsage, "--skip-existing needs --frames");
}

} // namespace osgRayTrace::app
