// ImageSize.cpp - looks into the headers of PNG and JPEG images. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/ImageSize.h"

#include <algorithm>

namespace osgRayTrace::gltf
{

namespace
{

/// Returns a big-endian number of so many bytes; 0 if the text ends before.
std::uint64_t numberAt(const std::string& bytes, std::size_t offset, std::size_t count)
{
    if (offset > bytes.size() || count > bytes.size() - offset) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
        value = value << 8 | static_cast<unsigned char>(bytes[offset + i]);
    return value;
}

/// Returns whether a JPEG marker begins a frame: SOF0 to SOF15 without DHT, JPG and DAC.
bool isFrame(std::uint64_t marker)
{
    return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

/// Returns whether no length follows a JPEG marker: TEM, and RST0 to RST7.
bool isBare(std::uint64_t marker)
{
    return marker == 0x01 || (marker >= 0xd0 && marker <= 0xd7);
}

std::uint64_t jpegPixels(const std::string& bytes)
{
    std::uint64_t most = 0;
    std::size_t offset = 2;
    while (offset + 4 <= bytes.size() && numberAt(bytes, offset, 1) == 0xff)
    {
        const std::uint64_t marker = numberAt(bytes, offset + 1, 1);
        if (isFrame(marker))
            most = std::max(most, numberAt(bytes, offset + 5, 2) * numberAt(bytes, offset + 7, 2));
        if (marker == 0xda) break; // the data of the scan follow
        offset += marker == 0xff ? 1 : 2;
        if (marker != 0xff && !isBare(marker))
            offset += static_cast<std::size_t>(numberAt(bytes, offset, 2));
    }
    return most;
}

} // namespace

std::uint64_t pixelsOf(const std::string& bytes)
{
    if (bytes.compare(0, 2, "\xff\xd8") == 0) return jpegPixels(bytes);
    const bool png = bytes.compare(0, 4, "\x89PNG") == 0;
    return png ? numberAt(bytes, 16, 4) * numberAt(bytes, 20, 4) : 0; // below 2^64
}

} // namespace osgRayTrace::gltf
