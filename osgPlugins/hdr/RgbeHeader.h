// RgbeHeader.h - the text that a Radiance picture file begins with. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/hdr/RgbeImage.h"

namespace osgRayTrace::engine
{

/// Tells the order of pixels in a file: lines of pixels, each of which is a row or a column of the
/// picture.
struct RgbeOrder
{
    bool columns = false;      ///< true: lines are columns
    bool linesFromEnd = false; ///< true: the first line is the top row, or the rightmost column
    bool pixelsFromEnd =
        false; ///< true: the first pixel of a line is its rightmost, or its top one
    int lines = 0;
    int length = 0; ///< pixels of a line
};

struct RgbeHeader
{
    RgbeImage image; ///< without pixels
    RgbeOrder order;
};

/// Reads a header and leaves the stream at the first byte of the pixels. Returns an empty string,
/// or one sentence that says what is wrong. The size is within the limits.
std::string readRgbeHeader(std::istream& stream, RgbeHeader& header);

} // namespace osgRayTrace::engine
