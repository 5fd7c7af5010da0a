// LightSizes.h - how large the lights of a scene are that OpenGL takes for points. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Light.h"

#include <osgRayTrace/RayTraceSettings>

#include <map>
#include <optional>
#include <string>

namespace osgRayTrace::engine
{

/// A size is a radius for point and spot lights [length, world], and an angular diameter for
/// directional ones [degrees].
struct LightSizes
{
    float radius = 0.0f;
    float angleDegrees = 0.0f;
    std::map<std::string, float> byName; ///< instead of both

    bool operator==(const LightSizes& other) const
    {
        return radius == other.radius && angleDegrees == other.angleDegrees &&
               byName == other.byName;
    }
};

/// "key=0.2,fill=1": names and sizes; "none" and "" are none. Nothing if it is not of this form, or
/// a size is negative or no finite number. A semicolon is as good as a comma.
std::optional<std::map<std::string, float>> parseLightSizes(const std::string& text);

LightSizes lightSizesOf(const RayTraceSettings& settings);

/// Makes a directional or point light as large as it is meant to be: by its own name, else that of
/// the last node of path, else by its kind. unit is Scene::unit. Returns the name that was used, or
/// "".
std::string applyLightSize(const LightSizes& sizes, const std::string& path, double unit,
                           Light& light);

} // namespace osgRayTrace::engine
