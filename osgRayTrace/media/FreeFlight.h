// FreeFlight.h - samples how far light travels before it collides. Layer: media.
// SPDX-License-Identifier: MIT
//
// Each channel c of an RGB medium has its own density of collisions, sigma_c exp(-sigma_c t). One
// channel is chosen with a probability p_c, and the sample has the weight of the balance heuristic
// over all channels [Miller19, sect. 5; Veach97, eq. 9.8]:
//
//   collision at t:      exp(-sigma t) / sum_c p_c sigma_c exp(-sigma_c t)
//   no collision up to d: exp(-sigma d) / sum_c p_c exp(-sigma_c d)
//
// Both are ratios of exponentials from which the largest is taken out, so that neither is 0 / 0 in
// media of any optical depth.
#pragma once

#include "osgRayTrace/media/Transmittance.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

struct FreeFlight
{
    bool collides = false;
    float distance = 0.0f; ///< [length]
    Vec3 weight{0.0f};     ///< transmittance over the density, or over the probability, of the end
};

/// Returns the probabilities of the channels, in proportion to what a path still carries.
inline Vec3 channelPmf(Vec3 throughput)
{
    const float sum = throughput.x + throughput.y + throughput.z;
    return sum > 0.0f && sum < kInfinity ? throughput / sum : Vec3(1.0f / 3.0f);
}

/// Chooses one of three channels, and makes u a number in [0,1) that does not depend on the choice.
inline int chooseChannel(Vec3 pmf, float& u)
{
    float begin = 0.0f;
    for (int c = 0; c < 2; ++c)
    {
        if (u < begin + pmf[c])
        {
            u = std::min((u - begin) / pmf[c], 0x1.fffffep-1f);
            return c;
        }
        begin += pmf[c];
    }
    u = pmf[2] > 0.0f ? std::clamp((u - begin) / pmf[2], 0.0f, 0x1.fffffep-1f) : 0.0f;
    return 2;
}

/// Returns exp(-sigma t) over the sum of pmf_c scale_c exp(-sigma_c t).
inline Vec3 flightWeight(Vec3 sigma, Vec3 pmf, Vec3 scale, float t)
{
    float least = kInfinity;
    for (int c = 0; c < 3; ++c)
        if (pmf[c] * scale[c] > 0.0f) least = std::min(least, sigma[c]);
    if (!(least < kInfinity)) return Vec3(0.0f);
    const Vec3 left = expOf((Vec3(least) - sigma) * t);
    const float density = glm::dot(pmf * scale, left);
    // A channel that is never chosen may have more light left than all that are.
    return density > 0.0f ? glm::min(left / density, 1e30f) : Vec3(0.0f);
}

/// Returns -log(1 - u), u in [0,1), with a relative error below 2.5e-7 in a fraction of the time of
/// log1p(-u): what 1 - u is rounded to has nearly the same ratio of its logarithm to its difference
/// from 1 [Goldberg91, theorem 4].
inline float depthOf(float u)
{
    const float left = 1.0f - u;
    return left < 1.0f ? u * (std::log(left) / (left - 1.0f)) : u;
}

/// Returns the next collision of light in a medium of this extinction, or none up to a length. u in
/// [0,1).
inline FreeFlight sampleFlight(Vec3 sigmaT, float length, Vec3 pmf, float u)
{
    const int channel = chooseChannel(pmf, u);
    FreeFlight flight;
    const float sigma = sigmaT[channel];
    const float t = sigma > 0.0f ? depthOf(u) / sigma : kInfinity;
    flight.collides = t < length;
    flight.distance = flight.collides ? t : length;
    flight.weight =
        flightWeight(sigmaT, pmf, flight.collides ? sigmaT : Vec3(1.0f), flight.distance);
    return flight;
}

/// Returns the probability that sampleFlight finds a collision.
inline float collisionProbability(Vec3 sigmaT, float length, Vec3 pmf)
{
    if (sigmaT.x == sigmaT.y && sigmaT.y == sigmaT.z)
        return -(pmf.x + pmf.y + pmf.z) * std::expm1(-sigmaT.x * length);
    float sum = 0.0f;
    for (int c = 0; c < 3; ++c)
        sum -= pmf[c] * std::expm1(-sigmaT[c] * length);
    return sum;
}

/// Returns a collision within the length: the distribution of sampleFlight on condition that light
/// collides [Villemin18, sect. 3]. Its weight is exp(-sigma t) over its own density; in a medium
/// without extinction nothing collides. u in [0,1).
inline FreeFlight sampleFlightWithin(Vec3 sigmaT, float length, Vec3 pmf, float u)
{
    Vec3 collided(0.0f);
    for (int c = 0; c < 3; ++c)
        collided[c] = -pmf[c] * std::expm1(-sigmaT[c] * length);
    const float probability = collided.x + collided.y + collided.z;
    FreeFlight flight;
    if (!(probability > 0.0f)) return flight;
    const int channel = chooseChannel(collided / probability, u);
    const float sigma = sigmaT[channel];
    const float t = -std::log1p(u * std::expm1(-sigma * length)) / sigma;
    flight.collides = true;
    flight.distance = std::clamp(t, 0.0f, length);
    flight.weight = flightWeight(sigmaT, pmf, sigmaT, flight.distance) * probability;
    return flight;
}

} // namespace osgRayTrace::engine
