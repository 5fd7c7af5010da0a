// PhaseFunction.h - how a medium spreads the light that it scatters. Layer: media.
// SPDX-License-Identifier: MIT
//
// The Henyey-Greenstein phase function of mean cosine g is [Henyey41, eq. 2]
//
//   p(cosTheta) = (1 - g^2) / (4 pi (1 + g^2 - 2 g cosTheta)^(3/2))
//
// cosTheta is 1 if the light goes straight on. A function that is 1 over all directions needs no
// weight if its samples have the density p.
//
// Water droplets of fog and clouds, of 5 to 50 micrometres, scatter as a share w of Draine's phase
// function and the rest of Henyey and Greenstein's do [Jendersie23]; Draine's is [Draine03]
//
//   p(cosTheta) = HG(g, cosTheta) (1 + alpha cosTheta^2) / (1 + alpha (1 + 2 g^2) / 3)
#pragma once

#include "osgRayTrace/sampling/Warp.h"
#include "osgRayTrace/scene/Medium.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

/// The largest absolute value of g: beyond it a float has too few directions left.
constexpr float kLargestAnisotropy = 0.999f;

/// The sizes for which the fit of droplets holds: their diameters [micrometres].
constexpr float kSmallestDroplet = 5.0f, kLargestDroplet = 50.0f;

/// Holds a phase function. A number alone is the g of Henyey and Greenstein.
struct Phase
{
    float g = 0.0f;
    float draineG = 0.0f, draineAlpha = 0.0f;
    float draineShare = 0.0f; ///< 0: Henyey and Greenstein alone

    Phase() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): media of one g are the common case
    Phase(float anisotropy) : g(anisotropy) {}

    bool operator==(const Phase& other) const
    {
        return g == other.g && draineG == other.draineG && draineAlpha == other.draineAlpha &&
               draineShare == other.draineShare;
    }
};

/// Returns the phase function of droplets of a diameter [micrometres], which is clamped.
Phase dropletPhase(float diameter);

/// Returns the phase function of a medium; what is out of range is clamped.
Phase phaseOf(const Medium& medium);

/// Returns the mean cosine between the directions before and after.
float meanCosine(const Phase& phase);

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

/// Returns a cosine with the density of Henyey and Greenstein's phase function. u in [0,1).
inline float sampleHenyeyGreenstein(float g, float u)
{
    const float z = 1.0f - 2.0f * u; // isotropic
    if (!(std::fabs(g) > 1e-3f)) return z;
    const float s = (1.0f - g * g) / (1.0f + g * z);
    return std::clamp((1.0f + g * g - s * s) / (2.0f * g), -1.0f, 1.0f);
}

/// Returns a direction at a cosine from a unit direction; v in [0,1) turns it around that.
inline Vec3 directionAround(Vec3 direction, float z, float v)
{
    const float across = std::sqrt(std::max(0.0f, 1.0f - z * z));
    float sine, cosine;
    sinCosTurn(v, sine, cosine);
    return turnedTo(direction, Vec3(across * cosine, across * sine, z));
}

/// Returns the direction in which light goes on that travelled in a unit direction. u, v in [0,1).
inline Vec3 samplePhase(float g, Vec3 direction, float u, float v)
{
    return directionAround(direction, sampleHenyeyGreenstein(g, u), v);
}

/// Returns what Draine's phase function is times that of Henyey and Greenstein.
inline float draineFactor(const Phase& phase, float cosTheta)
{
    const float alpha = phase.draineAlpha, g = phase.draineG;
    return (1.0f + alpha * cosTheta * cosTheta) / (1.0f + alpha * (1.0f + 2.0f * g * g) / 3.0f);
}

/// Returns evalPhase of any phase function.
inline float evalPhase(const Phase& phase, float cosTheta)
{
    const float plain = evalPhase(phase.g, cosTheta);
    if (!(phase.draineShare > 0.0f)) return plain;
    const float draine = evalPhase(phase.draineG, cosTheta) * draineFactor(phase, cosTheta);
    return plain + phase.draineShare * (draine - plain);
}

/// Returns a cosine with the density of Draine's phase function. A g nearer to 0 than 0.001 counts
/// as 0.001. alpha: not negative; u in [0,1).
float sampleDraine(float g, float alpha, float u);

/// Returns samplePhase of a phase function whose draineShare is above 0.
Vec3 sampleDroplets(const Phase& phase, Vec3 direction, float u, float v);

/// Returns samplePhase of any phase function.
inline Vec3 samplePhase(const Phase& phase, Vec3 direction, float u, float v)
{
    if (phase.draineShare > 0.0f) return sampleDroplets(phase, direction, u, v);
    return samplePhase(phase.g, direction, u, v);
}

} // namespace osgRayTrace::engine
