// PassSums.cpp - sums of passes between tiles and rows of pixels. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/PassSums.h"

#include "osgRayTrace/base/Assert.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// A pixel of the image, and of a tile's blocks.
struct Place
{
    std::size_t pixel;
    std::size_t block;
    std::size_t lane;

    std::size_t inTile() const { return block * kLanes + lane; }
    /// Returns the index of a channel's value in ExactSums.
    std::size_t value(std::size_t channel) const { return (block * 4 + channel) * kLanes + lane; }
};

/// Calls visit for each pixel of a tile that belongs to the image.
template <typename Visit> void forEachPixel(const Film& film, int tile, const Visit& visit)
{
    const int columns = std::min(kTileSize, film.width() - film.tileX(tile));
    const int rows = std::min(kTileSize, film.height() - film.tileY(tile));
    const auto width = static_cast<std::size_t>(film.width());
    for (int block = 0; block < kTileBlocks; ++block)
        for (int lane = 0; lane < kLanes; ++lane)
        {
            const int x = laneX(block, lane), y = laneY(block, lane);
            if (x >= columns || y >= rows) continue;
            visit(Place{static_cast<std::size_t>(film.tileY(tile) + y) * width +
                            static_cast<std::size_t>(film.tileX(tile) + x),
                        static_cast<std::size_t>(block), static_cast<std::size_t>(lane)});
        }
}

/// Returns the index of a value in PassSums::low.
std::size_t planed(const PassSums& sums, int half, std::size_t channel, const Place& place)
{
    return (static_cast<std::size_t>(half) * 4 + channel) * sums.pixels() + place.pixel;
}

ExactSum sumAt(const PassSums& sums, std::size_t i)
{
    return {sums.low[i], sums.high.empty() ? 0 : sums.high[i]};
}

void setSum(const ExactSum& sum, std::size_t i, PassSums& sums)
{
    sums.low[i] = sum.low;
    if (sum.high != 0 && sums.high.empty()) sums.high.assign(sums.low.size(), 0);
    if (!sums.high.empty()) sums.high[i] = sum.high;
}

/// Empties an array of zeros.
void dropZeros(std::vector<int64_t>& values)
{
    const bool zero =
        std::all_of(values.begin(), values.end(), [](int64_t value) { return value == 0; });
    if (zero) values.clear();
}

} // namespace

PassSums sumsOf(const Film& film, const PassSet& passes)
{
    PassSums sums;
    sums.width = film.width();
    sums.height = film.height();
    sums.passes = passes;
    sums.low.assign(PassSums::kPlanes * sums.pixels(), 0);
    sums.depth.assign(sums.pixels(), 1.0f);
    const ExactSums& exact = film.exactSums();
    for (int tile = 0; tile < film.tileCount(); ++tile)
    {
        OSGRAYTRACE_ASSERT(film.tilePasses(tile) == passes.count());
        const auto t = static_cast<std::size_t>(tile);
        const float* depth = film.hasDepth(tile) ? film.depth(tile) : nullptr;
        const auto take = [&](const Place& place)
        {
            for (int half = 0; half < 2; ++half)
                for (std::size_t channel = 0; channel < 4; ++channel)
                    if (film.halfPasses(tile, half) > 0)
                        setSum(exact.sum(t, half, place.value(channel)),
                               planed(sums, half, channel, place), sums);
            if (depth) sums.depth[place.pixel] = depth[place.inTile()];
        };
        forEachPixel(film, tile, take);
    }
    return sums;
}

void setFilm(const PassSums& sums, Film& film)
{
    film.reset(sums.width, sums.height, FilmSums::Exact);
    std::vector<ExactSum> values(ExactSums::kValues);
    for (int tile = 0; tile < film.tileCount(); ++tile)
    {
        for (int half = 0; half < 2; ++half)
        {
            std::fill(values.begin(), values.end(), ExactSum());
            const auto take = [&](const Place& place)
            {
                for (std::size_t channel = 0; channel < 4; ++channel)
                    values[place.value(channel)] = sumAt(sums, planed(sums, half, channel, place));
            };
            forEachPixel(film, tile, take);
            film.setHalf(tile, half, sums.passes.count(half), values.data());
        }
        float* depth = film.depth(tile);
        std::fill_n(depth, kTilePixels, 1.0f);
        if (sums.depth.empty()) continue;
        forEachPixel(film, tile,
                     [&](const Place& place) { depth[place.inTile()] = sums.depth[place.pixel]; });
    }
}

void addSums(const PassSums& from, PassSums& into)
{
    OSGRAYTRACE_ASSERT(from.width == into.width && from.height == into.height);
    OSGRAYTRACE_ASSERT(!from.passes.firstCommon(into.passes));
    if (from.passes.empty()) return;
    const bool earlier = into.passes.empty() ||
                         from.passes.ranges().front().first < into.passes.ranges().front().first;
    if (earlier) into.depth = from.depth;
    for (std::size_t i = 0; i < into.low.size(); ++i)
        setSum(added(sumAt(into, i), sumAt(from, i)), i, into);
    dropZeros(into.high);
    into.passes.add(from.passes);
}

void normalise(PassSums& sums)
{
    for (std::size_t i = 0; i < sums.low.size(); ++i)
        setSum(added(sumAt(sums, i), ExactSum()), i, sums);
    dropZeros(sums.high);
}

} // namespace osgRayTrace::engine
