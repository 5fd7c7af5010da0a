// LightSizes.h - sizes of lights that OpenGL takes for points. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Light.h"

#include <osgRayTrace/RayTraceSettings>

#include <map>
#include <optional>
#include <string>

namespace osgRayTrace::engine
{

/// Holds sizes of lights: a size is a radius for point and spot lights [length, world], and an
/// angular diameter for directional ones [degrees].
struct LightSizes
{
    float radius = 0.0f;
    float angleDegrees = 0.0f;
    std::map<std::string, float> byName; ///< sizes of single lights, instead of both

    bool operator==(const LightSizes& other) const
    {
        return radius == other.radius && angleDegrees == other.angleDegrees &&
               byName == other.byName;
    }
};

/// Parses names and sizes such as "key=0.2,fill=1"; "none" and "" are none. A semicolon is as good
/// as a comma. Returns nothing if the text has another form, or a size is negative or not finite.
std::optional<std::map<std::string, float>> parseLightSizes(const std::string& text);

LightSizes lightSizesOf(const RayTraceSettings& settings);

/// Gives a directional or point light its size: by the light's own name, otherwise by that of the
/// last node of path, otherwise by its kind. unit is Scene::unit. Returns the name that was used,
/// or "".
std::string applyLightSize(const LightSizes& sizes, const std::string& path, double unit,
                           Light& light);

} // namespace osgRayTrace::engine
