// Enlarge.cpp - display values of a small image where those of a larger one are shown. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/Enlarge.h"

#include "osgRayTrace/base/Parallel.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

namespace osgRayTrace::engine
{

namespace
{

/// A pixel's place in a line of other pixels.
struct Place
{
    std::size_t first, second; ///< whose middles it is between
    std::size_t nearest;
    float weight; ///< of the second
};

std::vector<Place> placesOf(int from, int to)
{
    std::vector<Place> places;
    places.reserve(static_cast<std::size_t>(to));
    const float scale = static_cast<float>(from) / static_cast<float>(to);
    const auto last = static_cast<std::size_t>(from - 1);
    for (int i = 0; i < to; ++i)
    {
        const float middle = (static_cast<float>(i) + 0.5f) * scale - 0.5f;
        const float at = std::clamp(middle, 0.0f, static_cast<float>(from - 1));
        Place place;
        place.first = static_cast<std::size_t>(at);
        place.second = std::min(place.first + 1, last);
        place.nearest = static_cast<std::size_t>((2 * int64_t(i) + 1) * from / (2 * int64_t(to)));
        place.weight = at - static_cast<float>(place.first);
        places.push_back(place);
    }
    return places;
}

/// Rounds at the end: adds 1/2.
void blendRows(const uint8_t* below, const uint8_t* above, float weight, std::vector<float>& row)
{
    for (std::size_t i = 0; i < row.size(); ++i)
    {
        const float low = static_cast<float>(below[i]), high = static_cast<float>(above[i]);
        row[i] = low + (high - low) * weight + 0.5f;
    }
}

void enlargeColors(const std::vector<float>& row, const std::vector<Place>& columns, uint8_t* rgba)
{
    for (std::size_t x = 0; x < columns.size(); ++x)
    {
        const Place& place = columns[x];
        const float* left = &row[4 * place.first];
        const float* right = &row[4 * place.second];
        uint32_t values[4];
        for (std::size_t c = 0; c < 4; ++c)
            values[c] = static_cast<uint32_t>(
                static_cast<int>(left[c] + (right[c] - left[c]) * place.weight));
        const uint32_t packed = values[0] | values[1] << 8 | values[2] << 16 | values[3] << 24;
        std::memcpy(rgba + 4 * x, &packed, 4);
    }
}

} // namespace

void enlarge(const DisplayPixels& small, const DisplayPixels& large, const Workers& workers)
{
    const std::vector<Place> columns = placesOf(small.width, large.width);
    const std::vector<Place> rows = placesOf(small.height, large.height);
    const auto from = static_cast<std::size_t>(small.width);
    const auto to = static_cast<std::size_t>(large.width);
    workers.forEach(rows.size(),
                    [&](std::size_t y)
                    {
                        const Place& place = rows[y];
                        std::vector<float> row(4 * from);
                        blendRows(small.rgba + 4 * from * place.first,
                                  small.rgba + 4 * from * place.second, place.weight, row);
                        enlargeColors(row, columns, large.rgba + 4 * to * y);
                        const float* depths = small.depth + from * place.nearest;
                        for (std::size_t x = 0; x < to; ++x)
                            large.depth[to * y + x] = depths[columns[x].nearest];
                    });
}

} // namespace osgRayTrace::engine
