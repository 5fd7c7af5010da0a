// Fog.h - OpenGL's fog: surfaces fade to a colour with their distance. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace osgRayTrace::engine
{

enum class FogMode : uint8_t
{
    None,
    Linear,
    Exponential,
    ExponentialSquared,
};

/// Tells what the fog of surfaces is.
enum class FogUse : uint8_t
{
    Depth,  ///< what OpenGL makes of it
    Medium, ///< a medium that fills the scene: see FogMedium.h
    Off,
};

/// Holds the fog of a surface [OpenGL21, sect. 3.10]. The colour is linear if the scene is, and
/// display-referred otherwise.
struct Fog
{
    FogMode mode = FogMode::None;
    bool radial = false; ///< true: by distance from the eye; false: by depth along the view's axis
    Vec3 color{0.0f};
    float density = 1.0f;           ///< [1/scene unit]
    float start = 0.0f, end = 1.0f; ///< Linear [scene units]
};

/// Returns the share of its own colour that a surface keeps at a distance [scene units]; the rest
/// is the fog's colour [OpenGL21, eq. 3.24-3.26]. If start and end are equal, the share of linear
/// fog is end - distance, clamped, as in Mesa.
inline float fogShare(const Fog& fog, float distance)
{
    const float z = std::fabs(distance);
    switch (fog.mode)
    {
    case FogMode::Linear:
    {
        const float range = fog.end - fog.start;
        return std::clamp((fog.end - z) / (range == 0.0f ? 1.0f : range), 0.0f, 1.0f);
    }
    case FogMode::Exponential:
        return std::exp(-fog.density * z);
    case FogMode::ExponentialSquared:
        return std::exp(-(fog.density * z) * (fog.density * z));
    case FogMode::None:
        break;
    }
    return 1.0f;
}

} // namespace osgRayTrace::engine
