// Film.cpp - sums of passes, their means and their errors. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/Film.h"

#include "osgRayTrace/base/Status.h"

#include <algorithm>
#include <cmath>
#include <new>

namespace osgRayTrace::engine
{

namespace
{

constexpr std::size_t kChannels = 4;
constexpr std::size_t kHalfFloats = kChannels * kTilePixels;

OSGRAYTRACE_KERNEL
void add(float* __restrict sums, const float* __restrict values)
{
    OSGRAYTRACE_SIMD
    for (std::size_t i = 0; i < kHalfFloats; ++i)
        sums[i] += values[i];
}

OSGRAYTRACE_KERNEL
void meanOf(const float* __restrict first, const float* __restrict second, float scale,
            float* __restrict out)
{
    OSGRAYTRACE_SIMD
    for (std::size_t i = 0; i < kHalfFloats; ++i)
        out[i] = (first[i] + second[i]) * scale;
}

OSGRAYTRACE_KERNEL
void scaled(const float* __restrict sums, float scale, float* __restrict out)
{
    OSGRAYTRACE_SIMD
    for (std::size_t i = 0; i < kHalfFloats; ++i)
        out[i] = sums[i] * scale;
}

float* floatsOf(TileRgba& values)
{
    return values[0].r.v;
}

} // namespace

void Film::reset(int width, int height)
{
    if (int64_t(width) * height > kMaxPixels)
        throw EngineError(StatusCode::OutOfMemory, "the image has more than 2^28 pixels");
    const bool resized = width != _width || height != _height;
    if (resized)
    {
        _width = _height = _tilesX = _tilesY = 0;
        const int tilesX = (width + kTileSize - 1) / kTileSize;
        const int tilesY = (height + kTileSize - 1) / kTileSize;
        const auto tiles = static_cast<std::size_t>(tilesX) * static_cast<std::size_t>(tilesY);
        try
        {
            // Values are written before they are read, tile by tile: by the first pass of each
            // half.
            _sums = UnclearedArray<RgbaLanes>(tiles * 2 * kTileBlocks);
            _depth = UnclearedArray<float>(tiles * kTilePixels);
            _passes.assign(tiles, 0);
        }
        catch (const std::bad_alloc&)
        {
            throw EngineError(StatusCode::OutOfMemory, "no memory for the image");
        }
        _width = width;
        _height = height;
        _tilesX = tilesX;
        _tilesY = tilesY;
    }
    std::fill(_passes.begin(), _passes.end(), 0);
    _holdsDepths = false;
    std::vector<double>().swap(_totals);
}

int Film::passes() const
{
    return _passes.empty() ? 0 : *std::min_element(_passes.begin(), _passes.end());
}

float* Film::sums(int tile, int half)
{
    return _sums[(static_cast<std::size_t>(tile) * 2 + static_cast<std::size_t>(half)) *
                 kTileBlocks]
        .r.v;
}

const float* Film::sums(int tile, int half) const
{
    return const_cast<Film*>(this)->sums(tile, half);
}

void Film::beginPass()
{
    const int next = passes();
    const bool folds = (next >> 1) % kFoldPasses == kFoldPasses - 1;
    if (folds && _totals.empty()) _totals.assign(_sums.size() * kChannels * kLanes, 0.0);
}

RgbaLanes* Film::firstPassStorage(int tile)
{
    const int passes = tilePasses(tile);
    return passes < 2 ? reinterpret_cast<RgbaLanes*>(sums(tile, passes)) : nullptr;
}

void Film::addPass(int tile, const RgbaLanes* values)
{
    if (RgbaLanes* storage = firstPassStorage(tile))
        std::copy(values, values + kTileBlocks, storage);
    else
        add(sums(tile, tilePasses(tile) & 1), values[0].r.v);
    finishPass(tile);
}

void Film::finishPass(int tile)
{
    int& passes = _passes[static_cast<std::size_t>(tile)];
    const int half = passes & 1;
    const int index = passes >> 1;
    ++passes;
    if (index % kFoldPasses == kFoldPasses - 1) fold(tile, half);
}

void Film::fold(int tile, int half)
{
    float* floats = sums(tile, half);
    double* totals = &_totals[static_cast<std::size_t>(floats - _sums[0].r.v)];
    for (std::size_t i = 0; i < kHalfFloats; ++i)
        totals[i] += floats[i];
    std::fill(floats, floats + kHalfFloats, 0.0f);
}

void Film::halfMean(int tile, int half, TileRgba& values) const
{
    const int count = (tilePasses(tile) + 1 - half) / 2;
    if (count == 0)
    {
        std::fill_n(floatsOf(values), kHalfFloats, 0.0f);
        return;
    }
    const float* floats = sums(tile, half);
    if (count < kFoldPasses)
    {
        scaled(floats, 1.0f / static_cast<float>(count), floatsOf(values));
        return;
    }
    const double* totals = &_totals[static_cast<std::size_t>(floats - _sums[0].r.v)];
    float* out = floatsOf(values);
    for (std::size_t i = 0; i < kHalfFloats; ++i)
        out[i] = static_cast<float>((totals[i] + floats[i]) / count);
}

void Film::mean(int tile, TileRgba& values) const
{
    const int count = tilePasses(tile);
    if (count < 2)
    {
        halfMean(tile, 0, values);
        return;
    }
    if (count < 2 * kFoldPasses - 1)
    {
        meanOf(sums(tile, 0), sums(tile, 1), 1.0f / static_cast<float>(count), floatsOf(values));
        return;
    }
    TileRgba second;
    halfMean(tile, 0, values);
    halfMean(tile, 1, second);
    const float weight = static_cast<float>(count / 2) / static_cast<float>(count);
    float* out = floatsOf(values);
    const float* other = floatsOf(second);
    for (std::size_t i = 0; i < kHalfFloats; ++i)
        out[i] += (other[i] - out[i]) * weight;
}

void Film::halfMeans(int tile, TileRgba& first, TileRgba& second) const
{
    halfMean(tile, 0, first);
    halfMean(tile, 1, second);
}

float Film::errorScale(int tile) const
{
    const int passes = tilePasses(tile);
    if (passes < 2) return 0.0f;
    if (passes % 2 == 0) return 0.5f;
    // One half has n passes and a mean of variance V, the other half has one pass more, of variance
    // s^2 alone. V is s^2 / n for independent passes and down to s^2 / n^2 for points that fill the
    // square evenly, whose mean a last pass makes worse. The code takes s^2 / n^1.5, about 3 % of
    // variance from either.
    const double n = passes / 2, last = n * std::sqrt(n); // last: s^2 / V
    const double variance = (2.0 * n * n + last) / ((2.0 * n + 1.0) * (2.0 * n + 1.0));
    const double difference = (n * n + last) / ((n + 1.0) * (n + 1.0)) + 1.0;
    return static_cast<float>(std::sqrt(variance / difference));
}

} // namespace osgRayTrace::engine
