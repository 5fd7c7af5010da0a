// Frames.cpp - reads ranges of frames and makes file names. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Frames.h"

#include "osgRayTrace/base/NumberText.h"

#include <algorithm>

namespace osgRayTrace::app
{

namespace
{

constexpr int kMostFrames = 10'000'000; ///< frame numbers are below this

std::optional<int> frameNumber(const std::string& text)
{
    const auto number = engine::parseNumber<int>(text);
    return number && *number >= 0 && *number < kMostFrames ? number : std::nullopt;
}

} // namespace

std::optional<FrameRange> frameRangeOf(const std::string& text)
{
    const std::size_t colon = text.find(':');
    const std::optional<int> first = frameNumber(text.substr(0, colon));
    const std::optional<int> last =
        colon == std::string::npos ? first : frameNumber(text.substr(colon + 1));
    if (!first || !last || *first > *last) return std::nullopt;
    return FrameRange{*first, *last};
}

std::optional<std::string> frameName(const std::string& pattern, int frame)
{
    const std::size_t percent = pattern.find('%');
    if (percent == std::string::npos || pattern.find('%', percent + 1) != std::string::npos)
        return std::nullopt;
    std::size_t end = percent + 1, width = 0;
    const bool padded = end + 1 < pattern.size() && pattern[end] == '0' &&
                        pattern[end + 1] >= '1' && pattern[end + 1] <= '9';
    if (padded)
    {
        width = static_cast<std::size_t>(pattern[end + 1] - '0');
        end += 2;
    }
    if (end >= pattern.size() || pattern[end] != 'd') return std::nullopt;
    const std::string number = std::to_string(frame);
    const std::string zeros(width - std::min(width, number.size()), '0');
    return pattern.substr(0, percent) + zeros + number + pattern.substr(end + 1);
}

} // namespace osgRayTrace::app
