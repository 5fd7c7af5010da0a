// Srgb.h - linear colours of glTF as the display-referred ones of OSG. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Vec4>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgRayTrace::gltf
{

/// Returns the display value, [0,1], of a linear one. OpenGL's fixed function shows colours of
/// vertices and materials as they are; a linear traced scene decodes them, which gives glTF's
/// linear colour again.
inline float displayValue(float linear)
{
    const float x = std::clamp(linear, 0.0f, 1.0f);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

/// Returns the linear value of a display value.
inline float linearValue(float display)
{
    return display <= 0.04045f ? display / 12.92f : std::pow((display + 0.055f) / 1.055f, 2.4f);
}

/// Encodes red, green and blue; alpha is linear in both.
inline osg::Vec4 displayColor(const osg::Vec4& linear)
{
    return {displayValue(linear.r()), displayValue(linear.g()), displayValue(linear.b()),
            std::clamp(linear.a(), 0.0f, 1.0f)};
}

inline osg::Vec4 displayColor(const std::array<float, 3>& linear)
{
    return displayColor(osg::Vec4(linear[0], linear[1], linear[2], 1.0f));
}

} // namespace osgRayTrace::gltf
