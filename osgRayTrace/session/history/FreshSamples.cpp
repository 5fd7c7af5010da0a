// FreshSamples.cpp - finds the pixels that have few samples, and adds what is traced for them.
// Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/FreshSamples.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/session/RenderSession.h"
#include "osgRayTrace/session/TileSamples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace osgRayTrace::engine
{

namespace
{

/// Calls body(pixel of the image, pixel of the tile) for the pixels of a tile in the image.
template <class Body> void forEachTilePixel(const SampledImage& image, int tile, const Body& body)
{
    const int across = tilesAlong(image.width);
    const int left = tile % across * kTileSize, bottom = tile / across * kTileSize;
    for (int b = 0; b < kTileBlocks; ++b)
        for (int i = 0; i < kLanes; ++i)
        {
            const int x = left + laneX(b, i), y = bottom + laneY(b, i);
            if (x < image.width && y < image.height)
                body(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(x),
                     b * kLanes + i);
        }
}

/// Returns how many samples a pixel is to get if all are to have so many.
int wantedOf(float count, int level)
{
    return std::min(std::max(level - static_cast<int>(std::ceil(count)), 0), kMostFresh);
}

/// Holds how many pixels of an image, or of a tile, have so many samples, rounded up: 0 to
/// kFreshEnough - 1.
using CountTable = std::array<std::size_t, kFreshEnough>;

/// Returns the tables of the tiles. Those of tiles without a pass are empty.
std::vector<CountTable> countPixels(const RenderSession& session, const SampledImage& image,
                                    const Workers& workers)
{
    const auto across = static_cast<std::size_t>(tilesAlong(image.width));
    const auto down = static_cast<std::size_t>(tilesAlong(image.height));
    std::vector<CountTable> tables(across * down, CountTable{});
    const auto countRow = [&](std::size_t row)
    {
        for (std::size_t tile = row * across; tile < (row + 1) * across; ++tile)
        {
            if (session.tilePasses(static_cast<int>(tile)) == 0) continue;
            const auto count = [&](std::size_t pixel, int)
            {
                const auto samples = static_cast<std::size_t>(std::ceil(image.count[pixel]));
                if (samples < kFreshEnough) ++tables[tile][samples];
            };
            forEachTilePixel(image, static_cast<int>(tile), count);
        }
    };
    workers.forEach(down, countRow);
    return tables;
}

/// Returns the number of samples that all pixels are to have, if no more samples than affordable
/// may be added altogether.
int levelOf(const std::vector<CountTable>& tables, int enough, double affordable)
{
    CountTable all = {};
    for (const CountTable& table : tables)
        for (std::size_t i = 0; i < all.size(); ++i)
            all[i] += table[i];
    const auto samplesFor = [&](int level)
    {
        double sum = 0.0;
        for (int count = 0; count < level; ++count)
            sum += static_cast<double>(all[static_cast<std::size_t>(count)]) *
                   wantedOf(static_cast<float>(count), level);
        return sum;
    };
    int level = enough;
    while (level > 0 && samplesFor(level) > affordable)
        --level;
    return level;
}

/// Returns the tiles of which pixels have less than level, with what these want.
std::vector<TileSamples> findWanting(const std::vector<CountTable>& tables,
                                     const SampledImage& image, int level, const Workers& workers)
{
    std::vector<int> wanting;
    for (std::size_t tile = 0; tile < tables.size(); ++tile)
        if (std::any_of(tables[tile].begin(), tables[tile].begin() + level,
                        [](std::size_t n) { return n > 0; }))
            wanting.push_back(static_cast<int>(tile));
    std::vector<TileSamples> tiles(wanting.size());
    const auto fill = [&](std::size_t k)
    {
        tiles[k].tile = wanting[k];
        const auto want = [&](std::size_t pixel, int own)
        { tiles[k].wanted[own] = static_cast<uint8_t>(wantedOf(image.count[pixel], level)); };
        forEachTilePixel(image, wanting[k], want);
    };
    workers.forEach(tiles.size(), fill);
    return tiles;
}

void addTo(SampledImage& image, const TileSamples& samples)
{
    const auto addPixel = [&](std::size_t pixel, int own)
    {
        if (samples.count[own] == 0) return;
        const auto added = static_cast<float>(samples.count[own]);
        float& count = image.count[pixel];
        const bool isNew = count == 0.0f;
        count += added;
        const RgbaLanes& mean = samples.mean[own / kLanes];
        const int i = own % kLanes;
        const float fresh[4] = {mean.r[i], mean.g[i], mean.b[i], mean.a[i]};
        for (std::size_t c = 0; c < 4; ++c)
        {
            float& value = image.radiance[4 * pixel + c];
            value = isNew ? fresh[c] : value + added / count * (fresh[c] - value);
        }
    };
    forEachTilePixel(image, samples.tile, addPixel);
}

} // namespace

void addFreshSamples(RenderSession& session, float most, const std::function<bool()>& shouldStop,
                     const Workers& workers, SampledImage& image)
{
    if (shouldStop()) return;
    const int enough = static_cast<int>(std::min(most, static_cast<float>(kFreshEnough)));
    const std::vector<CountTable> tables = countPixels(session, image, workers);
    const double affordable = kFreshShare * static_cast<double>(image.count.size());
    std::vector<TileSamples> tiles =
        findWanting(tables, image, levelOf(tables, enough, affordable), workers);
    session.samplePixels(tiles, shouldStop);
    workers.forEach(tiles.size(), [&](std::size_t i) { addTo(image, tiles[i]); });
}

} // namespace osgRayTrace::engine
