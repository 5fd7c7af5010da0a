// ExrPlanes.h - OpenEXR files with integers and texts, for data that go with a picture. Layer:
// osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/exr/ExrImage.h"

#include <cstdint>
#include <map>

namespace osgRayTrace::engine
{

struct ExrIntegers
{
    std::string name;
    std::vector<uint32_t> values; ///< width * height, row 0 at the bottom
};

/// A picture that any viewer shows, with channels and texts that it passes over.
struct ExrPlanes
{
    ExrImage picture;                         ///< channels of 32 bits; half does not count
    std::vector<ExrIntegers> integers;        ///< channels of 32 bits
    std::map<std::string, std::string> texts; ///< attributes of the header

    const ExrIntegers* find(const std::string& name) const;
};

// Each function returns an empty string, or one sentence that says what is wrong; none throws.

/// Reads all channels of a regular file without compression whose pixels fill its display window,
/// with the limits of size of readExr.
std::string readExrPlanes(const std::string& path, ExrPlanes& planes);

/// Writes the whole file without compression, or leaves the file that was there before: see
/// writeFileWhole.
std::string writeExrPlanes(const std::string& path, const ExrPlanes& planes);

} // namespace osgRayTrace::engine
