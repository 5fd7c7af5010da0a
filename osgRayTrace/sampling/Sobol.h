// Sobol.h - Owen-scrambled Sobol points in two dimensions, without tables. Layer: sampling.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/sampling/Hash.h"

namespace osgRayTrace::engine
{

OSGRAYTRACE_INLINE uint32_t reverseBits(uint32_t x)
{
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}

/// Returns a number whose bits are reversed after nested uniform (Owen) scrambling: each bit is
/// flipped or not by a hash of the seed and of the bits below it [Burley20, sect. 3; constants of
/// Vegdahl21].
OSGRAYTRACE_INLINE uint32_t scrambleReversed(uint32_t x, uint32_t seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// Returns the second Sobol dimension with its bits reversed: the Pascal triangle mod 2 applied to
/// the bits of the index, as a butterfly [Ahmed24].
OSGRAYTRACE_INLINE uint32_t sobolSecondReversed(uint32_t index)
{
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    index ^= (index >> 16) & 0x0000ffffu;
    return index;
}

/// Returns the seed of x, and seedOfY that of y, from a seed that is a hash already. The shifts
/// differ: with equal shifts the low bits of the two seeds, which become the high bits of the
/// point, depend on each other.
OSGRAYTRACE_INLINE uint32_t seedOfX(uint32_t seed)
{
    seed *= 0x2c1b3c6du;
    return seed ^ (seed >> 15);
}

OSGRAYTRACE_INLINE uint32_t seedOfY(uint32_t seed)
{
    seed *= 0x297a2d39u;
    return seed ^ (seed >> 17);
}

/// Sets x and y to point number index of the two-dimensional sequence that belongs to seed, in
/// [0,1)^2. Sequences of different seeds are independent, because they are shuffled and scrambled
/// apart [Burley20, sect. 4].
OSGRAYTRACE_INLINE void sobol2(uint32_t index, uint32_t seed, float& x, float& y)
{
    const uint32_t shuffled = reverseBits(scrambleReversed(reverseBits(index), seed));
    x = unitFloat(reverseBits(scrambleReversed(shuffled, seedOfX(seed))));
    y = unitFloat(reverseBits(scrambleReversed(sobolSecondReversed(shuffled), seedOfY(seed))));
}

/// Sets x and y as sobol2 does, without shuffling the index. Only sequences that have to be kept
/// apart need the shuffle; this function is for the first dimensions of a sample.
OSGRAYTRACE_INLINE void sobol2Ordered(uint32_t index, uint32_t seed, float& x, float& y)
{
    x = unitFloat(reverseBits(scrambleReversed(index, seedOfX(seed))));
    y = unitFloat(reverseBits(scrambleReversed(sobolSecondReversed(index), seedOfY(seed))));
}

/// Returns point number index of the one-dimensional sequence of seed, in [0,1).
OSGRAYTRACE_INLINE float sobol1(uint32_t index, uint32_t seed)
{
    const uint32_t shuffled = reverseBits(scrambleReversed(reverseBits(index), seed));
    return unitFloat(reverseBits(scrambleReversed(shuffled, seedOfX(seed))));
}

} // namespace osgRayTrace::engine
