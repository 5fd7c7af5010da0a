// StatisticsText.cpp - formats statistics. Layer: apps.
// SPDX-License-Identifier: MIT
#include "StatisticsText.h"

#include "apps/common/DrawnParts.h"
#include "apps/common/ErrorText.h"
#include "apps/common/Interruption.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>

namespace osgRayTrace::app
{

namespace
{

uint64_t allRays(const Statistics& statistics)
{
    return statistics.cameraRays + statistics.shadowRays + statistics.secondaryRays +
           statistics.photonRays;
}

/// Returns why a picture shows nothing; empty if it shows something. radiance: GL_RGBA, GL_FLOAT.
std::string blankness(const osg::Image& radiance)
{
    bool hit = false;
    for (int y = 0; y < radiance.t(); ++y)
    {
        const float* row = reinterpret_cast<const float*>(radiance.data(0, y));
        for (int x = 0; x < radiance.s(); ++x)
        {
            const float* pixel = row + 4 * x;
            if (pixel[0] != 0.0f || pixel[1] != 0.0f || pixel[2] != 0.0f) return {};
            hit = hit || pixel[3] != 0.0f;
        }
    }
    return hit ? "all that was hit is black: is there a light that reaches it?"
               : "nothing was hit: does the camera look at the scene (--eye, --center, --up)?";
}

} // namespace

std::string statisticsJson(const Options& options, const Statistics& statistics,
                           const std::optional<ErrorMeasures>& measures)
{
    nlohmann::ordered_json json;
    json["models"] = options.models;
    json["width"] = options.width;
    json["height"] = options.height;
    json["triangles"] = statistics.triangles;
    json["meshes"] = statistics.meshes;
    json["instances"] = statistics.instances;
    json["lights"] = statistics.lights;
    json["convertSeconds"] = statistics.convertSeconds;
    json["buildSeconds"] = statistics.buildSeconds;
    json["embreeBytes"] = statistics.embreeBytes;
    json["integrator"] = statistics.integrator;
    json["passes"] = statistics.passes;
    json["imageShare"] = statistics.imageShare;
    if (!statistics.lightNote.empty()) json["lightNote"] = statistics.lightNote;
    if (isInterrupted()) json["interrupted"] = interruptionName();
    json["renderSeconds"] = statistics.renderSeconds;
    json["rays"] = {{"camera", statistics.cameraRays},
                    {"shadow", statistics.shadowRays},
                    {"secondary", statistics.secondaryRays},
                    {"photon", statistics.photonRays},
                    {"total", allRays(statistics)}};
    if (statistics.photonRays || !statistics.photonNote.empty())
        json["photons"] = {
            {"stored", statistics.storedPhotons}, {"beams", statistics.storedBeams},
            {"points", statistics.storedPoints},  {"beamRadius", statistics.beamRadius},
            {"bytes", statistics.photonBytes},    {"hitPointBytes", statistics.hitPointBytes},
            {"radius", statistics.photonRadius},  {"note", statistics.photonNote}};
    if (statistics.collisions || !statistics.mediumNote.empty())
        json["media"] = {{"collisions", statistics.collisions},
                         {"cutWalks", statistics.cutWalks},
                         {"openWalks", statistics.openWalks},
                         {"note", statistics.mediumNote}};
    json["relativeError"] = statistics.relativeError;
    json["medianError"] = statistics.medianError;
    json["worstErrorShare"] = statistics.worstErrorShare;
    if (!statistics.denoiser.empty())
    {
        json["denoiser"] = statistics.denoiser;
        json["denoiseMilliseconds"] = statistics.denoiseMilliseconds;
        json["denoiseNote"] = statistics.denoiseNote;
    }
    if (options.settings->getAutoExposure()) json["autoExposure"] = statistics.autoExposure;
    json["droppedSamples"] = statistics.droppedSamples;
    json[options.context == Context::None ? "leftOut" : "drawnByOpenGL"] = drawnParts(statistics);
    json["conversion"] = statistics.conversion;
    json["conversionPaths"] = statistics.conversionPaths;
    if (!statistics.lastConversionReason.empty())
    {
        json["lastConversionReason"] = statistics.lastConversionReason;
        json["lastConversionPath"] = statistics.lastConversionPath;
    }
    if (measures)
    {
        json["reference"] = {{"file", options.reference},
                             {"rmse", measures->rmse},
                             {"relMse", measures->relMse},
                             {"meanRatio", measures->meanRatio}};
    }
    // File names may be of any encoding; bytes that are no UTF-8 are replaced.
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string statisticsLine(const Options& options, const Statistics& statistics,
                           const osg::Image& radiance)
{
    const double rate = statistics.renderSeconds > 0.0
                            ? 1e-6 * allRays(statistics) / statistics.renderSeconds
                            : 0.0;
    char text[160];
    std::snprintf(text, sizeof(text), "%s, %d passes in %.1f s, %.3g M rays/s",
                  statistics.integrator.c_str(), statistics.passes, statistics.renderSeconds, rate);
    std::string line = text;
    if (statistics.imageShare < 1.0)
    {
        std::snprintf(text, sizeof(text),
                      ", %.0f %% of the first one, the rest of the picture is missing",
                      std::floor(100.0 * statistics.imageShare));
        line += text;
    }
    const std::string blank = blankness(radiance);
    const auto proxies = statistics.conversion.find("traced.proxy");
    const bool proxiesAlone =
        proxies != statistics.conversion.end() && proxies->second == statistics.instances;
    if (!isTraced(statistics) || proxiesAlone)
        line += ", all of it is drawn by OpenGL";
    else if (!blank.empty())
        line += ", " + blank;
    else if (std::isfinite(statistics.relativeError))
        line += ", estimated error " + estimateText(statistics);
    if (statistics.relativeError > options.relativeError && options.relativeError > 0.0)
        line += ", --error " + errorText(options.relativeError) + " was not reached";
    if (statistics.droppedSamples > 0)
        line += ", " + std::to_string(statistics.droppedSamples) + " samples dropped";
    return line;
}

} // namespace osgRayTrace::app
