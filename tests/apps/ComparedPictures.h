// ComparedPictures.h - whether two pictures are the same but for rounding.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/exr/ExrImage.h"

#include <algorithm>
#include <cmath>
#include <string>

/// Returns whether two OpenEXR files have the same channels, with values that differ by rounding
/// at the most: a picture without a context has exact sums of passes, one in a context has sums of
/// floats.
inline bool differByRounding(const std::string& a, const std::string& b)
{
    using namespace osgRayTrace::engine;
    ExrImage one, other;
    if (!readExr(a, one).empty() || !readExr(b, other).empty()) return false;
    if (one.channels.size() != other.channels.size() || one.channels.empty()) return false;
    for (const ExrChannel& channel : one.channels)
    {
        const ExrChannel* same = other.find(channel.name);
        if (!same || same->values.size() != channel.values.size()) return false;
        for (std::size_t i = 0; i < channel.values.size(); ++i)
        {
            const float x = channel.values[i], y = same->values[i];
            if (std::fabs(x - y) > 1e-6f * std::max(std::fabs(x), std::fabs(y))) return false;
        }
    }
    return true;
}
