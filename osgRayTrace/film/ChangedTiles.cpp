// ChangedTiles.cpp - from marks of tiles to few rectangles. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/ChangedTiles.h"

#include "osgRayTrace/film/Film.h"

#include <algorithm>
#include <cstddef>

namespace osgRayTrace::engine
{

namespace
{

/// The begin of a copy takes as long as the copy of so many pixels.
constexpr int64_t kPixelsOfCall = 1024;

/// Returns the runs of marked tiles in a row of tiles, in tiles.
std::vector<PixelRect> runsOf(const uint8_t* row, int tiles, int y)
{
    std::vector<PixelRect> runs;
    for (int x = 0; x < tiles; ++x)
    {
        if (!row[x]) continue;
        if (!runs.empty() && runs.back().x + runs.back().width == x)
            ++runs.back().width;
        else
            runs.push_back({x, y, 1, 1});
    }
    return runs;
}

/// Joins each run with the rectangle below it that has the same two ends. Both lists are in order;
/// a rectangle that does not go on is moved to done.
void join(std::vector<PixelRect>& below, std::vector<PixelRect> runs, std::vector<PixelRect>& done)
{
    auto old = below.begin();
    for (PixelRect& run : runs)
    {
        for (; old != below.end() && old->x < run.x; ++old)
            done.push_back(*old);
        if (old == below.end() || old->x != run.x || old->width != run.width) continue;
        run.y = old->y;
        run.height += old->height;
        ++old;
    }
    done.insert(done.end(), old, below.end());
    below = std::move(runs);
}

} // namespace

void ChangedTiles::reset(int w, int h)
{
    width = w;
    height = h;
    const auto tiles =
        static_cast<std::size_t>(tilesAlong(w)) * static_cast<std::size_t>(tilesAlong(h));
    color.assign(tiles, 0);
    depth.assign(tiles, 0);
}

void ChangedTiles::add(const ChangedTiles& others)
{
    for (std::size_t i = 0; i < color.size(); ++i)
    {
        color[i] |= others.color[i];
        depth[i] |= others.depth[i];
    }
}

std::vector<PixelRect> changedRects(const std::vector<uint8_t>& marks, int width, int height)
{
    const int across = tilesAlong(width);
    std::vector<PixelRect> rects, open;
    for (int y = 0; y < tilesAlong(height); ++y)
        join(open,
             runsOf(&marks[static_cast<std::size_t>(y) * static_cast<std::size_t>(across)], across,
                    y),
             rects);
    rects.insert(rects.end(), open.begin(), open.end());

    int64_t pixels = 0;
    for (PixelRect& rect : rects)
    {
        rect.x *= kTileSize;
        rect.y *= kTileSize;
        rect.width = std::min(rect.width * kTileSize, width - rect.x);
        rect.height = std::min(rect.height * kTileSize, height - rect.y);
        pixels += int64_t(rect.width) * rect.height + kPixelsOfCall;
    }
    if (pixels > int64_t(width) * height) return {{0, 0, width, height}};
    return rects;
}

} // namespace osgRayTrace::engine
