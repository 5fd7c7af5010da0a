// TileOrder.h - an order of tiles in which any few of them are spread over the image. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace osgRayTrace::engine
{

/// Its multiples modulo count are all numbers below count, once each, and successive ones lie far apart: the
/// golden section of count, or the next below it that shares no factor with it.
inline std::size_t evenStride(std::size_t count)
{
    auto stride = static_cast<std::size_t>(0.6180339887 * static_cast<double>(count));
    while (stride > 1 && std::gcd(stride, count) != 1)
        --stride;
    return std::max<std::size_t>(stride, 1);
}

} // namespace osgRayTrace::engine
