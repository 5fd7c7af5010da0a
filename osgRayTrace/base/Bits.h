// Bits.h - counts the bits of masks. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Kernel.h"

#include <cstdint>

#if defined(_MSC_VER) && !defined(__clang__)
#include <intrin.h>
#endif

namespace osgRayTrace::engine
{

/// Returns the number of the lowest bit that is set. mask: not 0.
OSGRAYTRACE_INLINE int lowestBit(uint32_t mask)
{
#if defined(_MSC_VER) && !defined(__clang__)
    unsigned long bit;
    _BitScanForward(&bit, mask);
    return static_cast<int>(bit);
#else
    return __builtin_ctz(mask);
#endif
}

/// Returns how many bits are set.
OSGRAYTRACE_INLINE int countBits(uint32_t mask)
{
#if defined(_MSC_VER) && !defined(__clang__)
    mask -= (mask >> 1) & 0x55555555u;
    mask = (mask & 0x33333333u) + ((mask >> 2) & 0x33333333u);
    return static_cast<int>((((mask + (mask >> 4)) & 0x0f0f0f0fu) * 0x01010101u) >> 24);
#else
    return __builtin_popcount(mask);
#endif
}

} // namespace osgRayTrace::engine
