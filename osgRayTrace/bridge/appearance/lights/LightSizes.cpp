// LightSizes.cpp - reads the sizes of lights and applies them. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/lights/LightSizes.h"

#include "osgRayTrace/base/NumberText.h"

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kLargestRadius = 1e30f;
constexpr float kLargestDegrees = 180.0f;

/// Returns the number if it is all of the text, finite and not negative.
std::optional<float> parseSize(const std::string& text)
{
    const std::optional<float> value = parseNumber<float>(text);
    const bool good = value && *value >= 0.0f && *value <= kLargestRadius;
    return good ? value : std::nullopt;
}

std::string lastName(const std::string& path)
{
    return path.substr(path.rfind('/') + 1); // all of the path if there is no slash
}

} // namespace

std::optional<std::map<std::string, float>> parseLightSizes(const std::string& text)
{
    std::map<std::string, float> sizes;
    if (text.empty() || text == "none") return sizes;
    for (std::size_t begin = 0; begin <= text.size();)
    {
        const std::size_t end = std::min(text.find_first_of(",;", begin), text.size());
        const std::string item = text.substr(begin, end - begin);
        const std::size_t equals = item.rfind('=');
        if (equals == std::string::npos || equals == 0) return std::nullopt;
        const std::optional<float> size = parseSize(item.substr(equals + 1));
        if (!size) return std::nullopt;
        sizes[item.substr(0, equals)] = *size;
        begin = end + 1;
    }
    return sizes;
}

LightSizes lightSizesOf(const RayTraceSettings& settings)
{
    return {settings.getLightRadius(), settings.getLightAngle(),
            parseLightSizes(settings.getLightSizes()).value_or(std::map<std::string, float>())};
}

std::string applyLightSize(const LightSizes& sizes, const std::string& path, double unit,
                           Light& light)
{
    auto named = sizes.byName.find(light.name);
    if (named == sizes.byName.end()) named = sizes.byName.find(lastName(path));
    const bool isNamed = named != sizes.byName.end();
    if (light.kind == LightKind::Point)
        light.radius = static_cast<float>((isNamed ? named->second : sizes.radius) / unit);
    if (light.kind == LightKind::Directional)
    {
        const float degrees =
            std::min(isNamed ? named->second : sizes.angleDegrees, kLargestDegrees);
        light.sine = static_cast<float>(std::sin(osg::DegreesToRadians(0.5 * degrees)));
    }
    return isNamed ? named->first : std::string();
}

} // namespace osgRayTrace::engine
