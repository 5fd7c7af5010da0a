// Enlarge.cpp - display values of a small image where those of a larger one are shown. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/Enlarge.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Where a pixel's middle lies between the middles of those of a line of size pixels.
struct Between
{
    Between(int pixel, float scale, int size)
    {
        const float at = std::clamp((static_cast<float>(pixel) + 0.5f) * scale - 0.5f, 0.0f,
                                    static_cast<float>(size - 1));
        first = static_cast<int>(at);
        second = std::min(first + 1, size - 1);
        weight = at - static_cast<float>(first);
    }
    int first, second;
    float weight; ///< of the second
};

int nearest(int pixel, int from, int to)
{
    return static_cast<int>((2 * int64_t(pixel) + 1) * from / (2 * int64_t(to)));
}

} // namespace

void enlargeRow(const DisplayPixels& small, const DisplayPixels& large, int row)
{
    const Between y(row, static_cast<float>(small.height) / static_cast<float>(large.height),
                    small.height);
    const float scale = static_cast<float>(small.width) / static_cast<float>(large.width);
    const auto stride = static_cast<std::size_t>(small.width);
    const uint8_t* below = small.rgba + 4 * stride * static_cast<std::size_t>(y.first);
    const uint8_t* above = small.rgba + 4 * stride * static_cast<std::size_t>(y.second);
    const float* depths =
        small.depth + stride * static_cast<std::size_t>(nearest(row, small.height, large.height));
    const std::size_t start = static_cast<std::size_t>(row) * static_cast<std::size_t>(large.width);
    for (int column = 0; column < large.width; ++column)
    {
        const Between x(column, scale, small.width);
        const std::size_t a = 4 * static_cast<std::size_t>(x.first),
                          b = 4 * static_cast<std::size_t>(x.second);
        const std::size_t pixel = start + static_cast<std::size_t>(column);
        for (std::size_t c = 0; c < 4; ++c)
        {
            const float low = static_cast<float>(below[a + c]) * (1.0f - x.weight) +
                              static_cast<float>(below[b + c]) * x.weight;
            const float high = static_cast<float>(above[a + c]) * (1.0f - x.weight) +
                               static_cast<float>(above[b + c]) * x.weight;
            large.rgba[4 * pixel + c] =
                static_cast<uint8_t>(low * (1.0f - y.weight) + high * y.weight + 0.5f);
        }
        large.depth[pixel] = depths[nearest(column, small.width, large.width)];
    }
}

} // namespace osgRayTrace::engine
