// ExrImage.h - reads and writes OpenEXR files as named channels, without OSG. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

struct ExrChannel
{
    std::string name;          ///< "R", "A", or with a layer: "depth.Z", "normal.X"
    bool half = false;         ///< 16 bits a value in the file
    std::vector<float> values; ///< width * height, row 0 at the bottom
};

struct ExrImage
{
    int width = 0;
    int height = 0;
    std::vector<ExrChannel> channels;
    std::map<std::string, std::string> texts; ///< attributes to write; readExr passes over them

    /// Returns the channel of this name; null if there is none.
    const ExrChannel* find(const std::string& name) const;
};

/// Names the compressions, all of them lossless.
enum class ExrCompression
{
    Zip,
    Piz,
    None,
};

// Each function returns an empty string, or one sentence that says what is wrong; none throws.

/// Reads the display window of the first part, scanlines or tiles: pixels outside of the window are
/// cut off, and pixels that the file leaves out are 0. Only the channels in wanted are read, unless
/// wanted is empty. Integers become floats. The limits are 2^28 pixels, 2^20 a side and 2^30
/// values, and no more pixels than a file of this length can hold. Bad input leaves image as it
/// was.
std::string readExr(const std::string& path, ExrImage& image,
                    const std::vector<std::string>& wanted = {});

/// Reads a file that begins at the position of the stream, which must be able to seek.
std::string readExr(std::istream& stream, ExrImage& image,
                    const std::vector<std::string>& wanted = {});

/// Writes the whole file, or leaves the file that was there before: see writeFileWhole. Finite
/// values beyond half's range become its largest.
std::string writeExr(const std::string& path, const ExrImage& image,
                     ExrCompression compression = ExrCompression::Zip);

/// Writes to a stream; nothing of a file that cannot be encoded reaches the stream.
std::string writeExr(std::ostream& stream, const ExrImage& image,
                     ExrCompression compression = ExrCompression::Zip);

} // namespace osgRayTrace::engine
