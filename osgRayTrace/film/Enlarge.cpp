// Enlarge.cpp - linear interpolation of display values, row by row. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/Enlarge.h"

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Parallel.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

namespace
{

constexpr std::size_t kStripRows = 16; ///< rows of the large image made at once

/// Holds the places of the pixels of a line of the large image in a line of the small one.
struct Places
{
    std::vector<int> first;    ///< first of the two pixels whose middles it is between
    std::vector<int> step;     ///< step to the second pixel: 1, or 0 at the end
    std::vector<float> weight; ///< weight of the second pixel
    std::vector<int> nearest;
};

Places placesOf(int from, int to)
{
    Places places;
    const float scale = static_cast<float>(from) / static_cast<float>(to);
    for (int i = 0; i < to; ++i)
    {
        const float middle = (static_cast<float>(i) + 0.5f) * scale - 0.5f;
        const float at = std::clamp(middle, 0.0f, static_cast<float>(from - 1));
        const int first = static_cast<int>(at);
        places.first.push_back(first);
        places.step.push_back(first + 1 < from ? 1 : 0);
        places.weight.push_back(at - static_cast<float>(first));
        places.nearest.push_back(static_cast<int>((2 * int64_t(i) + 1) * from / (2 * int64_t(to))));
    }
    return places;
}

OSGRAYTRACE_KERNEL
void widenColors(const uint8_t* __restrict in, const int* __restrict first,
                 const int* __restrict step, const float* __restrict weight, std::size_t count,
                 float* __restrict out)
{
    for (std::size_t i = 0; i < count; ++i)
    {
        const uint8_t* a = in + 4 * first[i];
        const uint8_t* b = a + 4 * step[i];
        const float t = weight[i];
        OSGRAYTRACE_SIMD
        for (int c = 0; c < 4; ++c)
        {
            const float left = static_cast<float>(a[c]), right = static_cast<float>(b[c]);
            out[4 * i + static_cast<std::size_t>(c)] = left + (right - left) * t;
        }
    }
}

OSGRAYTRACE_KERNEL
void blendRows(const float* __restrict below, const float* __restrict above, float t,
               std::size_t count, uint8_t* __restrict out)
{
    OSGRAYTRACE_SIMD
    for (std::size_t i = 0; i < count; ++i)
        out[i] =
            static_cast<uint8_t>(static_cast<int>(below[i] + (above[i] - below[i]) * t + 0.5f));
}

/// Holds a row of the small image at the large image's width.
struct WideRow
{
    int row = -1;
    std::vector<float> rgba;

    void make(const DisplayPixels& small, const Places& columns, int wanted)
    {
        if (row == wanted) return;
        row = wanted;
        const std::size_t count = columns.first.size();
        rgba.resize(4 * count);
        widenColors(
            small.rgba + 4 * static_cast<std::size_t>(row) * static_cast<std::size_t>(small.width),
            columns.first.data(), columns.step.data(), columns.weight.data(), count, rgba.data());
    }
};

/// Writes the depth of the nearest pixel, so that depths of neighbours in the small image stay
/// those of neighbours.
void spreadDepths(const float* in, const std::vector<int>& nearest, float* out)
{
    for (std::size_t x = 0; x < nearest.size(); ++x)
        out[x] = in[nearest[x]];
}

} // namespace

void enlarge(const DisplayPixels& small, const DisplayPixels& large, const Workers& workers)
{
    const Places columns = placesOf(small.width, large.width);
    const Places rows = placesOf(small.height, large.height);
    const auto from = static_cast<std::size_t>(small.width);
    const auto to = static_cast<std::size_t>(large.width);
    const auto height = static_cast<std::size_t>(large.height);
    const auto makeStrip = [&](std::size_t strip)
    {
        WideRow below, above;
        const std::size_t begin = strip * kStripRows, end = std::min(height, begin + kStripRows);
        for (std::size_t y = begin; y < end; ++y)
        {
            const int row = rows.first[y];
            if (above.row == row) std::swap(below, above);
            below.make(small, columns, row);
            above.make(small, columns, row + rows.step[y]);
            blendRows(below.rgba.data(), above.rgba.data(), rows.weight[y], 4 * to,
                      large.rgba + 4 * to * y);
            float* depths = large.depth + to * y;
            if (y > begin && rows.nearest[y] == rows.nearest[y - 1])
                std::copy_n(depths - to, to, depths);
            else
                spreadDepths(small.depth + from * static_cast<std::size_t>(rows.nearest[y]),
                             columns.nearest, depths);
        }
    };
    workers.forEach((height + kStripRows - 1) / kStripRows, makeStrip);
}

} // namespace osgRayTrace::engine
