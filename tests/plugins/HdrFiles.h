// HdrFiles.h - Radiance pictures for tests of osgdb_hdr, byte by byte. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/hdr/RgbeImage.h"
#include "tests/Catch.h"

#include <osg/Image>
#include <osgDB/Registry>

#include <sstream>
#include <string>
#include <vector>

namespace osgRayTrace::engine::test
{

using Pixels = std::vector<Rgbe>;

/// Returns our plugin, or fails: OSG's plugin has another name.
inline osgDB::ReaderWriter* hdrPlugin()
{
    osgDB::ReaderWriter* result = osgDB::Registry::instance()->getReaderWriterForExtension("hdr");
    REQUIRE(result);
    REQUIRE(std::string(result->className()) == "Radiance Image Reader/Writer");
    return result;
}

inline osgDB::ReaderWriter::ReadResult readHdr(const std::string& bytes,
                                               const std::string& options = "")
{
    std::istringstream stream(bytes);
    const osg::ref_ptr<osgDB::Options> parsed = new osgDB::Options(options);
    return hdrPlugin()->readImage(stream, parsed);
}

/// Reads the bytes as an image, or fails.
inline osg::ref_ptr<osg::Image> imageOf(const std::string& bytes, const std::string& options = "")
{
    auto result = readHdr(bytes, options);
    INFO(result.message());
    REQUIRE(result.success());
    return result.getImage();
}

inline std::string headerOf(const std::string& resolution, const std::string& variables = "")
{
    return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + variables + "\n" + resolution + "\n";
}

/// Returns the pixels as they are.
inline std::string flat(const Pixels& pixels)
{
    std::string bytes;
    for (const Rgbe& pixel : pixels)
        for (const std::uint8_t value : pixel)
            bytes += static_cast<char>(value);
    return bytes;
}

/// Returns a run of the colour, in the format of 1985.
inline std::string oldRun(const Rgbe& pixel, int count)
{
    Pixels pixels{pixel};
    for (int rest = count - 1; rest > 0; rest >>= 8)
        pixels.push_back({1, 1, 1, static_cast<std::uint8_t>(rest & 255)});
    return flat(pixels);
}

/// Returns a line in the format of 1991 without runs.
inline std::string newLine(const Pixels& pixels)
{
    const std::size_t length = pixels.size();
    std::string bytes{2, 2, static_cast<char>(length >> 8), static_cast<char>(length & 255)};
    for (std::size_t component = 0; component < 4; ++component)
        for (std::size_t i = 0; i < length; ++i)
        {
            if (i % 100 == 0) bytes += static_cast<char>(std::min<std::size_t>(100, length - i));
            bytes += static_cast<char>(pixels[i][component]);
        }
    return bytes;
}

/// Returns a line in the format of 1991 that is one run.
inline std::string newRun(const Rgbe& pixel, int length)
{
    std::string bytes{2, 2, static_cast<char>(length >> 8), static_cast<char>(length & 255)};
    for (const std::uint8_t value : pixel)
        for (int left = length; left > 0; left -= 127)
        {
            bytes += static_cast<char>(128 + std::min(left, 127));
            bytes += static_cast<char>(value);
        }
    return bytes;
}

inline const float* valuesAt(const osg::Image& image, int x, int y)
{
    return reinterpret_cast<const float*>(image.data(x, y));
}

/// Returns pixels that all differ, with mantissas as writers make them.
inline Pixels somePixels(std::size_t count)
{
    Pixels pixels;
    for (std::size_t i = 0; i < count; ++i)
        pixels.push_back({static_cast<std::uint8_t>(128 + i % 128),
                          static_cast<std::uint8_t>(i * 7), static_cast<std::uint8_t>(i / 3),
                          static_cast<std::uint8_t>(120 + i % 16)});
    return pixels;
}

} // namespace osgRayTrace::engine::test
