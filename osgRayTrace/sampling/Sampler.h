// Sampler.h - a random number for each (seed, pixel, pass, dimension). Layer: sampling.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/sampling/Sobol.h"

namespace osgRayTrace::engine
{

/// Names the use of each dimension of a sample. Each name is a two-dimensional point of its own;
/// those from BounceFirst on repeat for each bounce, kDimensionsPerBounce apart.
enum Dimension : uint32_t
{
    DimensionPixel = 0,
    DimensionBounceFirst = 1,

    DimensionBsdfDirection = 0, ///< offsets within a bounce
    DimensionBsdfLobe = 1,      ///< x: lobe, y: Russian roulette
    DimensionLightPoint = 2,
    DimensionLightChoice = 3,

    // These dimensions are above those of all bounces.
    DimensionDiscEdge = 0x40000000, ///< of a pixel
    DimensionLens = 0x40000001,     ///< of a pixel
    DimensionMoment = 0x40000002,   ///< of a pass
    DimensionGround = 0x40000003,   ///< of a ray from the eye; and the next two
};
constexpr uint32_t kDimensionsPerBounce = 4;

/// Holds what decides on the random numbers of a pass. Passes alternate between two halves with
/// independent sequences: the difference of the halves then estimates the error of their mean
/// without bias. Sequences of halves, pixels, dimensions and seeds are independent.
struct PassKey
{
    uint32_t seed = 0;  ///< hash of the user's seed and the half
    uint32_t index = 0; ///< number of the pass within its half
};

inline PassKey passKey(uint32_t userSeed, int pass)
{
    return {hash(userSeed, static_cast<uint32_t>(pass) & 1u), static_cast<uint32_t>(pass) >> 1};
}

/// Returns the key of everything random about a pixel, for pixels up to 2^16 a side. The key is
/// hashed again with each dimension.
OSGRAYTRACE_INLINE uint32_t pixelSeed(const PassKey& key, uint32_t x, uint32_t y)
{
    return key.seed ^ hash(x | (y << 16));
}

OSGRAYTRACE_INLINE uint32_t dimensionSeed(uint32_t pixelSeed, uint32_t dimension)
{
    return hash(pixelSeed + dimension * 0x9e3779b9u);
}

OSGRAYTRACE_INLINE uint32_t bounceDimension(int bounce, uint32_t offset)
{
    return DimensionBounceFirst + static_cast<uint32_t>(bounce) * kDimensionsPerBounce + offset;
}

/// Returns when a pass looks while a shutter is open, in [0,1). All pixels of a pass look at once.
inline float momentOf(uint32_t userSeed, int pass)
{
    const PassKey key = passKey(userSeed, pass);
    return sobol1(key.index, dimensionSeed(key.seed, DimensionMoment));
}

} // namespace osgRayTrace::engine
