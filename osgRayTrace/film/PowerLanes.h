// PowerLanes.h - logarithms and powers for loops over lanes. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"

#include <cstring>

namespace osgRayTrace::engine
{

/// Returns 2^x for x in [-126, 127] with a relative error below 3e-6, by a polynomial through
/// Chebyshev nodes.
OSGRAYTRACE_INLINE float exp2Lanes(float x)
{
    const float whole = static_cast<float>(static_cast<int>(x + (x < 0.0f ? -0.5f : 0.5f)));
    const float f = x - whole;
    const float series =
        1.0f + f * (0.693121045f + f * (0.240223490f + f * (0.0559219758f + f * 0.00966636852f)));
    const int exponent = (static_cast<int>(whole) + 127) * (1 << 23);
    float scale;
    std::memcpy(&scale, &exponent, sizeof(scale));
    return series * scale;
}

/// Returns log2(x) for x > 0 and normal with an absolute error below 6e-6, by a polynomial through
/// Chebyshev nodes, without a division.
OSGRAYTRACE_INLINE float log2Lanes(float x)
{
    int bits;
    std::memcpy(&bits, &x, sizeof(bits));
    const int shifted = bits - 0x3f3504f3; // sqrt(1/2): the mantissa ends in [0.707, 1.414)
    const int exponent = shifted >> 23;
    const int mantissaBits = bits - exponent * (1 << 23);
    float m;
    std::memcpy(&m, &mantissaBits, sizeof(m));
    const float t = m - 1.0f;
    const float series =
        1.44270044f +
        t * (-0.721195752f +
             t * (0.479925573f + t * (-0.366925771f + t * (0.316898187f + t * -0.202289264f))));
    return static_cast<float>(exponent) + t * series;
}

} // namespace osgRayTrace::engine
