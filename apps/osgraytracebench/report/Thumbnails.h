// Thumbnails.h - small pictures for a page, within its text. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Measurement.h"

#include <string>
#include <vector>

namespace osgRayTrace::bench
{

/// Holds the pictures of a scene: an <img> element each, empty if there is no plugin that writes
/// PNG.
struct SceneThumbnails
{
    std::string scene, title;
    std::string reference;
    struct Line
    {
        std::string method, budget;
        std::string picture;
        std::string error; ///< |x - r| / r: see errorScale
    };
    std::vector<Line> lines;
};

std::string thumbnail(const Reference& reference);
std::string thumbnail(const Pixels& pixels, const Reference& reference);

/// Returns the relative error of each pixel's luminance: black for 1e-4 and below, through red and
/// yellow to white for 1 and above, logarithmic.
std::string errorThumbnail(const Pixels& pixels, const Reference& reference);

} // namespace osgRayTrace::bench
