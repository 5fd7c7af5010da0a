// QuickCompare.h - bounds and comparisons in lanes by the bits of floats. Layer: base.
// SPDX-License-Identifier: MIT
//
// AVX-512 compares floats into mask registers. From there to a result that select() makes of two
// values it takes nine cycles, where the largest of two integers takes one. Kernels are a single
// turn of a loop, so their time is that of the longest chain of results. Bits of floats that are
// not negative have the order of the floats, and those of all negative floats are below them.
#pragma once

#include "osgRayTrace/base/Lanes.h"

namespace osgRayTrace::engine
{

OSGRAYTRACE_INLINE int32_t signedBits(float x)
{
    int32_t bits;
    std::memcpy(&bits, &x, sizeof(bits));
    return bits;
}

OSGRAYTRACE_INLINE float floatOfBits(int32_t bits)
{
    float x;
    std::memcpy(&x, &bits, sizeof(x));
    return x;
}

/// Returns x, or the bound if x is less. bound: not negative. x: not NaN.
OSGRAYTRACE_INLINE float atLeast(float x, float bound)
{
    const int32_t a = signedBits(x), b = signedBits(bound);
    return floatOfBits(a > b ? a : b);
}

/// Returns x, or the bound if x is more. bound: not negative. x: not NaN.
OSGRAYTRACE_INLINE float atMost(float x, float bound)
{
    const int32_t a = signedBits(x), b = signedBits(bound);
    return floatOfBits(a < b ? a : b);
}

/// Returns all bits set if the sign of x is, else 0. Zero may have either sign.
OSGRAYTRACE_INLINE uint32_t signMask(float x)
{
    return static_cast<uint32_t>(signedBits(x) >> 31);
}

/// Returns all bits set if a is less than b, else 0. The difference must not be NaN, and -0 counts
/// as less than 0.
OSGRAYTRACE_INLINE uint32_t isLess(float a, float b)
{
    return signMask(a - b);
}

} // namespace osgRayTrace::engine
