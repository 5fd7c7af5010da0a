// Thumbnails.cpp - PNG by OSG's plugin, base64 by hand. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/Thumbnails.h"

#include "apps/osgraytracebench/report/DisplayValues.h"

#include <osgDB/Registry>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace osgRayTrace::bench
{

namespace
{

constexpr int kShownWidth = 192; ///< [pixels]

std::string base64(const std::string& bytes)
{
    static const char* const kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3)
    {
        unsigned group = 0;
        for (std::size_t b = 0; b < 3; ++b)
            group =
                group << 8 | (i + b < bytes.size() ? static_cast<unsigned char>(bytes[i + b]) : 0u);
        for (std::size_t d = 0; d < 4; ++d)
            text += d <= bytes.size() - i ? kDigits[group >> (18 - 6 * d) & 63u] : '=';
    }
    return text;
}

std::string imageElement(const std::vector<float>& display, int width, int height,
                         const std::string& description)
{
    osgDB::ReaderWriter* writer = osgDB::Registry::instance()->getReaderWriterForExtension("png");
    if (!writer) return {};
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int y = 0; y < height; ++y)
        for (int i = 0; i < 3 * width; ++i)
        {
            const std::size_t index =
                static_cast<std::size_t>(y) * 3 * width + static_cast<std::size_t>(i);
            image->data(0, y)[i] = static_cast<unsigned char>(std::lround(255.0f * display[index]));
        }
    std::ostringstream stream;
    if (!writer->writeImage(*image, stream).success()) return {};
    return "<img width=\"" + std::to_string(kShownWidth) + "\" alt=\"" + description +
           "\" src=\"data:image/png;base64," + base64(stream.str()) + "\">";
}

double luminanceOf(double r, double g, double b)
{
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

} // namespace

std::string thumbnail(const Reference& reference)
{
    return imageElement(displayValues(reference), reference.width, reference.height, "reference");
}

std::string thumbnail(const Pixels& pixels, const Reference& reference)
{
    return imageElement(displayValues(pixels, reference), pixels.width, pixels.height, "picture");
}

std::string errorThumbnail(const Pixels& pixels, const Reference& reference)
{
    constexpr double kDecades = 4.0;
    const double least = 0.01 * reference.meanLuminance;
    std::vector<float> display;
    for (std::size_t i = 0; i < pixels.rgb.size(); i += 3)
    {
        const double x = luminanceOf(pixels.rgb[i], pixels.rgb[i + 1], pixels.rgb[i + 2]);
        const double r =
            luminanceOf(reference.mean[i], reference.mean[i + 1], reference.mean[i + 2]);
        const double relative = std::abs(x - r) / std::max(std::abs(r), least);
        const double heat = 1.0 + std::log10(std::max(relative, 1e-30)) / kDecades; // 0 to 1
        for (int c = 0; c < 3; ++c)
            display.push_back(static_cast<float>(std::clamp(3.0 * heat - c, 0.0, 1.0)));
    }
    return imageElement(display, pixels.width, pixels.height, "relative error");
}

} // namespace osgRayTrace::bench
