// Transmittance.h - what homogeneous media leave of light, and add to it, on a way. Layer: media.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <cmath>

namespace osgRayTrace::engine
{

/// Returns exp of three channels, which are often alike.
inline Vec3 expOf(Vec3 x)
{
    return x.x == x.y && x.y == x.z ? Vec3(std::exp(x.x)) : glm::exp(x);
}

/// Returns the share of light that is left after a distance: exp(-sigmaT distance).
inline Vec3 transmittance(Vec3 sigmaT, float distance)
{
    return expOf(-sigmaT * distance);
}

/// Returns the radiance that a medium of this emission per length sends along a way: the integral
/// of emission exp(-sigmaT t) over t from 0 to distance.
inline Vec3 emittedAlong(Vec3 emission, Vec3 sigmaT, float distance)
{
    Vec3 sum;
    for (int c = 0; c < 3; ++c)
    {
        const float depth = sigmaT[c] * distance;
        const float mean = depth > 1e-4f ? -std::expm1(-depth) / depth : 1.0f - 0.5f * depth;
        sum[c] = emission[c] * distance * mean;
    }
    return sum;
}

} // namespace osgRayTrace::engine
