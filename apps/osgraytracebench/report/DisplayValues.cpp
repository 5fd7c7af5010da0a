// DisplayValues.cpp - the exposure of a reference, and tone mapping. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/DisplayValues.h"

#include "osgRayTrace/film/ToneMap.h"

#include <algorithm>

namespace osgRayTrace::bench
{

namespace
{

constexpr double kShownLuminance = 0.4;

} // namespace

std::vector<float> displayValues(const Pixels& pixels, const Reference& reference)
{
    const double exposure = kShownLuminance / reference.meanLuminance;
    std::vector<float> values;
    values.reserve(pixels.rgb.size());
    for (const float linear : pixels.rgb)
        values.push_back(
            std::clamp(engine::srgbFromLinear(static_cast<float>(linear * exposure)), 0.0f, 1.0f));
    return values;
}

std::vector<float> displayValues(const Reference& reference)
{
    const Pixels pixels{reference.width, reference.height,
                        std::vector<float>(reference.mean.begin(), reference.mean.end())};
    return displayValues(pixels, reference);
}

} // namespace osgRayTrace::bench
