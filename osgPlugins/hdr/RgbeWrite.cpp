// RgbeWrite.cpp - encodes lines of pixels as runs. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/exr/ExrError.h"
#include "osgPlugins/hdr/RgbeImage.h"

#include <algorithm>
#include <ostream>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kShortestLine = 8,
              kLongestLine = 0x7fff; ///< lengths of lines that the format of 1991 is for
constexpr int kShortestRun = 4;      ///< shorter runs take no less than single bytes
constexpr int kLongestRun = 127, kMostSingle = 128;

int runAt(const Rgbe* line, int length, int i, std::size_t component)
{
    const int most = std::min(length - i, kLongestRun);
    int run = 1;
    while (run < most && line[i + run][component] == line[i][component])
        ++run;
    return run;
}

void appendComponent(std::string& bytes, const Rgbe* line, int length, std::size_t component)
{
    for (int i = 0; i < length;)
    {
        int single = 0, run = 0;
        for (; i + single < length && single < kMostSingle; ++single)
        {
            run = runAt(line, length, i + single, component);
            if (run >= kShortestRun) break;
            run = 0;
        }
        if (single > 0) bytes += static_cast<char>(single);
        for (const int end = i + single; i < end; ++i)
            bytes += static_cast<char>(line[i][component]);
        if (run == 0) continue;
        bytes += static_cast<char>(128 + run);
        bytes += static_cast<char>(line[i][component]);
        i += run;
    }
}

/// Returns the pixel's value in other numbers if readers would take the pixel for a run.
Rgbe unmistakable(const Rgbe& pixel)
{
    if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) return pixel;
    if (pixel[3] == 0) return {0, 0, 0, 0};
    return {2, 2, 2, static_cast<std::uint8_t>(pixel[3] - 1)};
}

void appendLine(std::string& bytes, const Rgbe* line, int length)
{
    if (length < kShortestLine || length > kLongestLine)
    {
        for (int i = 0; i < length; ++i)
            for (const std::uint8_t value : unmistakable(line[i]))
                bytes += static_cast<char>(value);
        return;
    }
    bytes += {2, 2, static_cast<char>(length >> 8), static_cast<char>(length & 255)};
    for (std::size_t component = 0; component < 4; ++component)
        appendComponent(bytes, line, length, component);
}

} // namespace

std::string writeRgbe(std::ostream& stream, const RgbeImage& image)
{
    return caught(
        [&]() -> std::string
        {
            if (!isRgbeSize(image.width, image.height))
                return "an image of this size cannot be written";
            const auto width = static_cast<std::size_t>(image.width);
            if (image.pixels.size() != width * static_cast<std::size_t>(image.height))
                return "the image has another number of pixels";
            std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_";
            bytes += image.xyz ? "xyze\n\n-Y " : "rgbe\n\n-Y ";
            bytes += std::to_string(image.height) + " +X " + std::to_string(image.width) + "\n";
            for (int y = image.height - 1; y >= 0; --y)
                appendLine(bytes, &image.pixels[static_cast<std::size_t>(y) * width], image.width);
            stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
            return stream ? "" : "the stream cannot be written";
        });
}

} // namespace osgRayTrace::engine
