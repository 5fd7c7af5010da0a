// ErrorEstimate.cpp - the error of pixels and tiles, from the film's two halves. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/ErrorEstimate.h"

#include "osgRayTrace/base/Parallel.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kColors = 3;
constexpr double kDark = 0.01;             ///< keeps dark tiles from dominating
constexpr std::size_t kWorstPixels = 1000; ///< one of so many pixels is among the worst

/// Holds the halves' means of a tile and what makes errors of their differences.
struct TileHalves
{
    TileRgba first, second;
    float firstWeight = 0.5f; ///< share of the first half in the image
    double squareScale = 0.0; ///< factor of (a - b)^2 that makes it the variance of the mean
    int64_t pixels = 0;
};

/// Holds what errors of a tile are relative to, channel by channel.
struct TileScale
{
    double mean[kColors];    ///< R, of the image
    double inverse[kColors]; ///< squareScale / (R^2 + kDark)
};

struct TileError
{
    double squares = 0.0;        ///< sum over pixels and RGB of the relative squared errors
    double typicalSquares = 0.0; ///< the same, relative to max(r, R)
    float worst = 0.0f;          ///< largest sum over RGB of a pixel
    BiasProducts bias;           ///< relative to R
    double luminanceScale = 0.0; ///< turns a square of luminance into the sum of relative squares
};

using PixelSquares = FloatLanes[kTileBlocks];

/// Makes the pixels of a tile that are not in the image black.
void clearOutside(int columns, int rows, TileRgba& values)
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        for (int i = 0; i < kLanes; ++i)
        {
            if (laneX(b, i) < columns && laneY(b, i) < rows) continue;
            values[b].r[i] = values[b].g[i] = values[b].b[i] = 0.0f;
        }
    }
}

void readHalves(const Film& film, int tile, TileHalves& halves)
{
    film.halfMeans(tile, halves.first, halves.second);
    const int columns = std::min(kTileSize, film.width() - film.tileX(tile));
    const int rows = std::min(kTileSize, film.height() - film.tileY(tile));
    if (columns < kTileSize || rows < kTileSize)
    {
        clearOutside(columns, rows, halves.first);
        clearOutside(columns, rows, halves.second);
    }
    const int passes = film.tilePasses(tile);
    const double scale = film.errorScale(tile);
    halves.firstWeight = static_cast<float>(film.halfPasses(tile, 0)) / static_cast<float>(passes);
    halves.squareScale = scale * scale;
    halves.pixels = int64_t(columns) * rows;
}

const FloatLanes& channelOf(const RgbaLanes& block, int channel)
{
    return channel == 0 ? block.r : channel == 1 ? block.g : block.b;
}

/// Adds lane by lane, so that the loop needs no order of its additions, and in double, which has
/// room for bright values.
OSGRAYTRACE_KERNEL
void addLanes(const FloatLanes& first, const FloatLanes& second, double weight,
              Lanes<double>& __restrict sums)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const double x = first[i], y = second[i];
        sums[i] += weight * x + (1.0 - weight) * y;
    }
}

TileScale scaleOf(const TileHalves& halves)
{
    TileScale scale;
    for (int channel = 0; channel < kColors; ++channel)
    {
        Lanes<double> sums{};
        for (int b = 0; b < kTileBlocks; ++b)
            addLanes(channelOf(halves.first[b], channel), channelOf(halves.second[b], channel),
                     static_cast<double>(halves.firstWeight), sums);
        double sum = 0.0;
        for (int i = 0; i < kLanes; ++i)
            sum += sums[i];
        const double mean = sum / static_cast<double>(halves.pixels);
        scale.mean[channel] = mean;
        scale.inverse[channel] = halves.squareScale / (mean * mean + kDark);
    }
    return scale;
}

/// Adds the relative squared errors of one channel of a block: to squares relative to the tile, to
/// typical relative to max(r, R). Sums are double, which has room for squares of bright values.
OSGRAYTRACE_KERNEL
void addSquares(const FloatLanes& first, const FloatLanes& second, double weight, double mean,
                double squareScale, double inverse, FloatLanes& __restrict squares,
                Lanes<double>& __restrict typical)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const double x = first[i], y = second[i];
        const double difference2 = (x - y) * (x - y);
        const double own = weight * x + (1.0 - weight) * y;
        const double reference = own > mean ? own : mean;
        squares[i] += static_cast<float>(difference2 * inverse);
        typical[i] += difference2 * squareScale / (reference * reference + kDark);
    }
}

/// Sets squares to the pixels' sums over RGB of their relative squared errors, and typical to sums
/// of those relative to max(r, R).
void squaresOf(const TileHalves& halves, const TileScale& scale, PixelSquares& squares,
               Lanes<double>& typical)
{
    typical = Lanes<double>{};
    for (int b = 0; b < kTileBlocks; ++b)
    {
        squares[b] = FloatLanes{};
        for (int channel = 0; channel < kColors; ++channel)
            addSquares(channelOf(halves.first[b], channel), channelOf(halves.second[b], channel),
                       static_cast<double>(halves.firstWeight), scale.mean[channel],
                       halves.squareScale, scale.inverse[channel], squares[b], typical);
    }
}

/// Returns the sum over RGB of the relative squares of a difference that has a luminance of 1 and
/// the colour of the tile.
double luminanceScaleOf(const TileHalves& halves, const TileScale& scale)
{
    const Vec3d mean(scale.mean[0], scale.mean[1], scale.mean[2]);
    const double tileLuminance = static_cast<double>(luminance(Vec3(mean)));
    if (!(tileLuminance > 0.0) || !(halves.squareScale > 0.0)) return 0.0;
    const Vec3d inverse(scale.inverse[0], scale.inverse[1], scale.inverse[2]);
    return glm::dot(mean * mean, inverse) / (halves.squareScale * tileLuminance * tileLuminance);
}

/// differences: those of the tile; null: there are none.
TileError errorOf(const Film& film, int tile, const DiscDifferences* differences)
{
    TileHalves halves;
    readHalves(film, tile, halves);
    const TileScale scale = scaleOf(halves);
    PixelSquares squares;
    Lanes<double> typical;
    squaresOf(halves, scale, squares, typical);
    TileError error;
    if (differences)
        error.bias = biasProducts(*differences, film.tilePasses(tile),
                                  Vec3d(scale.inverse[0], scale.inverse[1], scale.inverse[2]) /
                                      halves.squareScale);
    error.luminanceScale = luminanceScaleOf(halves, scale);
    for (const FloatLanes& block : squares)
    {
        for (int i = 0; i < kLanes; ++i)
        {
            error.squares += static_cast<double>(block[i]);
            error.worst = std::max(error.worst, block[i]);
        }
    }
    for (int i = 0; i < kLanes; ++i)
        error.typicalSquares += typical[i];
    return error;
}

int64_t pixelsOf(const Film& film, int tile)
{
    return int64_t(std::min(kTileSize, film.width() - film.tileX(tile))) *
           std::min(kTileSize, film.height() - film.tileY(tile));
}

/// Returns the sum of the worst pixels' squares. If k pixels are asked for, they are no smaller
/// than the kth of the tiles' largest pixels, so that at most k tiles are looked at again.
double worstSquares(const Film& film, const std::vector<TileError>& tiles, const Workers& workers)
{
    const std::size_t count = std::max<std::size_t>(
        1, static_cast<std::size_t>(int64_t(film.width()) * film.height()) / kWorstPixels);
    std::vector<std::size_t> order(tiles.size());
    for (std::size_t tile = 0; tile < order.size(); ++tile)
        order[tile] = tile;
    const std::size_t looked = std::min(count, order.size());
    std::partial_sort(
        order.begin(), order.begin() + static_cast<std::ptrdiff_t>(looked), order.end(),
        [&](std::size_t a, std::size_t b) { return tiles[a].worst > tiles[b].worst; });
    const float least = tiles[order[looked - 1]].worst;

    std::vector<std::vector<float>> found(looked);
    workers.forEach(looked,
                    [&](std::size_t k)
                    {
                        TileHalves halves;
                        readHalves(film, static_cast<int>(order[k]), halves);
                        PixelSquares squares;
                        Lanes<double> typical;
                        squaresOf(halves, scaleOf(halves), squares, typical);
                        for (const FloatLanes& block : squares)
                            for (int i = 0; i < kLanes; ++i)
                                if (block[i] >= least) found[k].push_back(block[i]);
                    });
    std::vector<float> worst;
    for (const std::vector<float>& tile : found)
        worst.insert(worst.end(), tile.begin(), tile.end());
    std::sort(worst.begin(), worst.end(), std::greater<float>());
    worst.resize(std::min(worst.size(), count));
    double sum = 0.0;
    for (const float square : worst)
        sum += static_cast<double>(square);
    return sum;
}

/// Returns the median of the values above zero: tiles that show nothing tell nothing.
double medianOf(std::vector<double> values)
{
    values.erase(std::remove(values.begin(), values.end(), 0.0), values.end());
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace

ErrorEstimate estimateError(const Film& film, const Workers& workers,
                            const std::vector<DiscDifferences>& differences,
                            const FootprintBiases& footprints)
{
    if (film.passes() < 2 || !(film.errorScale(0) > 0.0f)) return {};
    std::vector<TileError> tiles(static_cast<std::size_t>(film.tileCount()));
    workers.forEach(tiles.size(),
                    [&](std::size_t tile)
                    {
                        tiles[tile] = errorOf(film, static_cast<int>(tile),
                                              differences.empty() ? nullptr : &differences[tile]);
                    });
    double squares = 0.0;
    std::vector<double> typical(tiles.size()), pixels(tiles.size());
    std::vector<BiasProducts> biases(tiles.size());
    std::vector<double> scales(tiles.size());
    for (std::size_t tile = 0; tile < tiles.size(); ++tile)
    {
        squares += tiles[tile].squares;
        pixels[tile] = static_cast<double>(pixelsOf(film, static_cast<int>(tile)));
        typical[tile] = tiles[tile].typicalSquares / (kColors * pixels[tile]);
        biases[tile] = tiles[tile].bias;
        scales[tile] = tiles[tile].luminanceScale;
    }
    squares += std::max(squaredBias(biases, pixels), squaredBias(footprints.compared, scales) +
                                                         squaredBias(footprints.later, scales));
    const double values = kColors * double(film.width()) * film.height();
    ErrorEstimate estimate;
    estimate.relative = std::sqrt(squares / values);
    estimate.median = std::sqrt(medianOf(std::move(typical)));
    if (squares > 0.0) estimate.worstShare = worstSquares(film, tiles, workers) / squares;
    return estimate;
}

} // namespace osgRayTrace::engine
