// ToneMap.cpp - the sRGB transfer function. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/ToneMap.h"

#include <cmath>

namespace osgRayTrace::engine
{

float srgbFromLinear(float linear)
{
    const float x = std::fabs(linear);
    const float y = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
    return std::copysign(y, linear);
}

float linearFromSrgb(float encoded)
{
    const float x = std::fabs(encoded);
    const float y = x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
    return std::copysign(y, encoded);
}

} // namespace osgRayTrace::engine
