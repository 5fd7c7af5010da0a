// PhaseFunction.h - how a medium spreads the light that it scatters. Layer: media.
// SPDX-License-Identifier: MIT
//
// The Henyey-Greenstein phase function of mean cosine g is [Henyey41, eq. 2]
//
//   p(cosTheta) = (1 - g^2) / (4 pi (1 + g^2 - 2 g cosTheta)^(3/2))
//
// cosTheta is 1 if the light goes straight on. A function that is 1 over all directions needs no
// weight if its samples have the density p.
#pragma once

#include "osgRayTrace/sampling/Warp.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

/// The largest absolute value of g: beyond it a float has too few directions left.
constexpr float kLargestAnisotropy = 0.999f;

/// Returns the share of scattered light for each direction [1/sr], which is also the density of
/// samplePhase. cosTheta: cosine between the directions in which the light travels before and
/// after.
inline float evalPhase(float g, float cosTheta)
{
    // 1 + g^2 - 2 g cosTheta without cancellation.
    const float away = 1.0f - std::fabs(g);
    const float d = away * away + 2.0f * std::fabs(g) * (1.0f - (g < 0.0f ? -cosTheta : cosTheta));
    return 0.25f * kInvPi * (1.0f - g * g) / (d * std::sqrt(d));
}

/// Returns the direction in which light goes on that travelled in a unit direction. u, v in [0,1).
inline Vec3 samplePhase(float g, Vec3 direction, float u, float v)
{
    float z = 1.0f - 2.0f * u; // isotropic
    if (std::fabs(g) > 1e-3f)
    {
        const float s = (1.0f - g * g) / (1.0f + g * z);
        z = std::clamp((1.0f + g * g - s * s) / (2.0f * g), -1.0f, 1.0f);
    }
    const float across = std::sqrt(std::max(0.0f, 1.0f - z * z));
    float sine, cosine;
    sinCosTurn(v, sine, cosine);
    return turnedTo(direction, Vec3(across * cosine, across * sine, z));
}

} // namespace osgRayTrace::engine
