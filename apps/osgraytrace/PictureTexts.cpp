// PictureTexts.cpp - words for the picture and its camera. Layer: apps.
// SPDX-License-Identifier: MIT
#include "PictureTexts.h"

#include "apps/common/ViewText.h"
#include "osgRayTrace/base/NumberText.h"

#include <osgRayTrace/Version>

#include <cmath>

namespace osgRayTrace::app
{

namespace
{

/// Returns the options that crop the picture; empty if it is whole.
std::string cropOf(const Options& options)
{
    if (!options.crop) return "";
    const Crop& crop = *options.crop;
    std::string text = " --size";
    for (const int value : {crop.fullWidth, crop.fullHeight})
        text += ' ' + std::to_string(value);
    text += " --crop";
    for (const int value : {crop.left, crop.top, options.width, options.height})
        text += ' ' + std::to_string(value);
    return text;
}

} // namespace

std::map<std::string, std::string> pictureTexts(const Options& options, const Camera& camera,
                                                const Statistics& statistics)
{
    if (options.isPart()) return {};
    std::map<std::string, std::string> texts{
        {"osgRayTrace.version", osgRayTraceGetVersion()},
        {"osgRayTrace.integrator", statistics.integrator},
        {"osgRayTrace.passes", std::to_string(statistics.passes)},
        {"osgRayTrace.seed", std::to_string(options.settings->getSeed())},
        {"osgRayTrace.camera", viewText(camera.view, camera.projection) + cropOf(options)},
    };
    if (std::isfinite(statistics.relativeError))
        texts["osgRayTrace.error"] = engine::numberText(statistics.relativeError);
    return texts;
}

} // namespace osgRayTrace::app
