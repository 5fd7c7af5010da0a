// Frames.h - the frames of an animation and the names of their files. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace osgRayTrace::app
{

/// Frames first to last, both of them included.
struct FrameRange
{
    int first = 0, last = 0;
};

/// Returns the range that "12" or "0:250" states; nothing for other texts.
std::optional<FrameRange> frameRangeOf(const std::string& text);

/// Returns the file name of a frame: its number takes the place of the name's only %d, or of %0Nd
/// with zeros up to N digits. Nothing if the name has no such place, more than one, or another %.
std::optional<std::string> frameName(const std::string& pattern, int frame);

} // namespace osgRayTrace::app
