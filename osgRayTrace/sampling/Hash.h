// Hash.h - integer hashing for random numbers that depend on their key alone. Layer: sampling.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"

#include <cstdint>

namespace osgRayTrace::engine
{

/// Mixes all bits of x; the map is a bijection [Wellons18, lowbias32].
OSGRAYTRACE_INLINE uint32_t hash(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

/// Returns a hash of two keys, which is not symmetric.
OSGRAYTRACE_INLINE uint32_t hash(uint32_t a, uint32_t b)
{
    return hash(b + 0x9e3779b9u + hash(a));
}

/// Returns a number in [0,1), uniform, from the upper 24 bits.
OSGRAYTRACE_INLINE float unitFloat(uint32_t bits)
{
    return static_cast<float>(static_cast<int32_t>(bits >> 8)) * 0x1p-24f;
}

} // namespace osgRayTrace::engine
