// OptionChecks.cpp - which options of the command line go together. Layer: apps.
// SPDX-License-Identifier: MIT
#include "OptionChecks.h"

#include "PictureFormat.h"
#include "Video.h"
#include "apps/common/Failure.h"

#include <algorithm>

namespace osgRayTrace::app
{

namespace
{

constexpr double kMaxPixels = 1 << 28;

/// Throws Failure(kUsage) if --write-materials stands beside something else to print or write.
void checkWrittenMaterials(const Options& options)
{
    if (options.writtenMaterials.empty()) return;
    const std::pair<const char*, bool> others[] = {{"--names", options.names},
                                                   {"-o", !options.outputs.empty()},
                                                   {"--report", options.report},
                                                   {"--checkpoint", !options.checkpoint.empty()},
                                                   {"--stats", !options.statistics.empty()}};
    for (const auto& [name, given] : others)
        if (given) throw Failure(kUsage, std::string("--write-materials excludes ") + name);
}

/// Throws Failure(kUsage) if frames cannot be told apart by their files, or have one file for all.
void checkFrames(const Options& options)
{
    if (!options.frames) return;
    if (options.outputs.empty()) throw Failure(kUsage, "--frames needs an -o FILE");
    if (!options.reference.empty()) throw Failure(kUsage, "--frames excludes --reference");
    std::vector<std::string> files = options.outputs;
    if (!options.statistics.empty()) files.push_back(options.statistics);
    for (const std::string& file : files)
        if (!isVideo(file) && !frameName(file, 0))
            throw Failure(kUsage, file + ": --frames needs one place for the number in the name, "
                                         "as in out.%04d.png");
}

/// Throws Failure if there are no frames for a video, or nothing that can make it.
void checkVideo(const Options& options)
{
    const auto videos = std::count_if(options.outputs.begin(), options.outputs.end(), isVideo);
    if (videos == 0) return;
    if (videos > 1) throw Failure(kUsage, "one -o FILE is a video at most");
    if (!options.frames)
        throw Failure(kUsage, "a video needs --frames, --turntable or --camera-path");
    if (options.skipsExisting) throw Failure(kUsage, "--skip-existing excludes videos");
    const std::string problem = whyNoVideo();
    if (!problem.empty()) throw Failure(kCannotWrite, problem);
}

/// Throws Failure(kUsage) if passes cannot be kept, or joined, as the options ask.
void checkParts(const Options& options)
{
    const auto exclude = [](const char* option, const char* other, bool given)
    {
        if (given) throw Failure(kUsage, std::string(option) + " excludes " + other);
    };
    const char* const part = options.mpi                  ? "--mpi"
                             : options.checkpoint.empty() ? "--passes A:B"
                                                          : "--checkpoint";
    if (options.isPart())
    {
        exclude(part, "--frames", options.frames.has_value());
        exclude(part, "--context", options.context != Context::None);
    }
    exclude("--mpi", "--auto-exposure", options.mpi && options.settings->getAutoExposure());
    if (!options.checkpoint.empty() && formatOf(options.checkpoint) != Format::Exr)
        throw Failure(kUsage, "--checkpoint " + options.checkpoint + ": the name ends in .exr");
    exclude("--send-scene", "--shutter", options.sendsScene && options.shutter > 0.0);
    exclude("--shutter", "--context", options.shutter > 0.0 && options.context != Context::None);
    if (options.merged.empty()) return;
    exclude("--merge", "models", !options.models.empty());
    exclude("--merge", "--mpi", options.mpi);
    exclude("--merge", "--aov", !options.channels.empty());
    exclude("--merge", "--stats", !options.statistics.empty());
    exclude("--merge", "--report", options.report);
    exclude("--merge", "--reference", !options.reference.empty());
    exclude("--merge", "--frames", options.frames.has_value());
    exclude("--merge", "--camera-path", options.cameraPath.valid());
    exclude("--merge", "--turntable", options.turnFrames != 0);
    exclude("--merge", "--shutter", options.shutter > 0.0);
    exclude("--merge", "--context", options.context != Context::None);
    exclude("--merge", "--names", options.names);
    exclude("--merge", "--crop", options.crop.has_value());
    exclude("--merge", "--background", options.backdrop.wanted);
    exclude("--merge", "lights", options.lights.any() || options.lights.headlight.has_value());
    for (const auto& [name, value] : options.assignments)
        exclude("--merge", ("--" + name).c_str(), name != "exposure" && name != "tone-curve");
    if (options.outputs.empty() && options.checkpoint.empty())
        throw Failure(kUsage, "--merge needs -o or --checkpoint");
}

} // namespace

void checkOptions(const Options& options)
{
    checkParts(options);
    if (options.models.empty() && options.merged.empty())
        throw Failure(kUsage, "no MODEL given; --help shows the options");
    checkWrittenMaterials(options);
    checkFrames(options);
    checkVideo(options);
    const bool lists =
        options.names || !options.writtenMaterials.empty() || !options.checkpoint.empty();
    if (options.outputs.empty() && !options.report && !lists)
        throw Failure(kUsage, "no -o FILE given; --help shows the options");
    if (options.width < 1 || options.height < 1 ||
        double(options.width) * options.height > kMaxPixels)
    {
        throw Failure(kUsage,
                      "--size: width and height are at least 1, their product at most 2^28");
    }

    bool exr = false;
    for (const std::string& output : options.outputs)
    {
        if (isVideo(output)) continue;
        const std::optional<Format> format = formatOf(output);
        if (!format)
            throw Failure(kUsage, "-o " + output +
                                      ": the name ends in none of .exr, .png, .jpg, "
                                      ".mp4, .mov, .mkv, .webm");
        exr = exr || *format == Format::Exr;
    }
    if (!options.channels.empty() && !exr) throw Failure(kUsage, "--aov needs an -o FILE.exr");
}

} // namespace osgRayTrace::app
