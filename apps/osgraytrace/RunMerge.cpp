// RunMerge.cpp - joins checkpoints that different machines have made. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Checkpoint.h"
#include "PictureFile.h"
#include "Run.h"
#include "apps/common/Failure.h"

#include <cstdio>

namespace osgRayTrace::app
{

namespace
{

/// Returns all passes of the files together.
Checkpoint joined(const std::vector<std::string>& files)
{
    Checkpoint all = readCheckpoint(files.front());
    for (std::size_t i = 1; i < files.size(); ++i)
    {
        const std::string problem = all.sums.add(readCheckpoint(files[i]).sums);
        if (!problem.empty())
            throw Failure(kCannotLoad, "cannot join " + files[i] + " to " + files.front() +
                                           (i > 1 ? " and those after it: " : ": ") + problem);
    }
    return all;
}

} // namespace

int runMerge(const Options& options)
{
    checkFiles(options);
    Checkpoint all = joined(options.merged);
    for (const auto& [name, value] : options.assignments)
    {
        if (name == "exposure") all.exposureEv = options.settings->getExposure();
        if (name == "tone-curve") all.toneCurve = options.settings->get(name);
    }
    Picture picture;
    picture.radiance = all.sums.getColorImage();
    picture.display = all.sums.getDisplayImage(all.exposureEv, all.clearColor, all.toneCurve);
    if (!picture.radiance || !picture.display)
        throw Failure(kCannotLoad, "the checkpoints are damaged, or there is not enough memory");
    const int code = writeAll(options, options.outputs, picture, {});
    if (!options.checkpoint.empty()) writeCheckpoint(options.checkpoint, all);
    std::printf("%d passes: %s\n", all.sums.passCount(), all.sums.passes.c_str());
    return code;
}

} // namespace osgRayTrace::app
