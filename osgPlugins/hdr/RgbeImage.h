// RgbeImage.h - reads and writes Radiance's picture files (.hdr), without OSG. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

constexpr int kRgbeMaxSide = 1 << 20;
constexpr long long kRgbeMaxPixels = 1LL << 28;

/// Holds three mantissas and the exponent that they share [Ward91]: a component is its mantissa
/// times 2^(exponent - 136), and 0 if the exponent is 0.
using Rgbe = std::array<std::uint8_t, 4>;

/// Holds pixels as they are in the file, and the values of its header.
struct RgbeImage
{
    int width = 0;
    int height = 0;
    std::vector<Rgbe> pixels; ///< width * height, row 0 at the bottom
    bool xyz = false;         ///< true: the components are CIE X, Y, Z instead of red, green, blue
    std::array<double, 3> factors{1, 1,
                                  1}; ///< EXPOSURE times COLORCORR: pixels were multiplied by them
    double gamma = 1;                 ///< pixels were raised to 1 / gamma
};

/// Returns true if a picture of this size is not empty and within the limits.
inline bool isRgbeSize(long long width, long long height)
{
    return width > 0 && height > 0 && width <= kRgbeMaxSide && height <= kRgbeMaxSide &&
           width * height <= kRgbeMaxPixels;
}

// Each function returns an empty string, or one sentence that says what is wrong; none throws.

/// Reads a picture of any orientation: rows of single pixels or of runs, by the format of 1985 or
/// of 1991. The function takes time and memory in proportion to the bytes of the stream, or to 2^24
/// pixels if those are more. It takes memory for pixels after it has seen that all of them are
/// there. Bad input leaves image as it was.
std::string readRgbe(std::istream& stream, RgbeImage& image);

/// Writes rows from the top, as runs by the format of 1991 if they are of a length that the format
/// knows. The header has no more than the format: factors and gamma of image are 1. Nothing of an
/// image that cannot be encoded reaches the stream.
std::string writeRgbe(std::ostream& stream, const RgbeImage& image);

} // namespace osgRayTrace::engine
