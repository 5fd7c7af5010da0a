// Film.cpp - sums of passes, their means and their errors. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/Film.h"

#include "osgRayTrace/base/Status.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
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

void Film::reset(int width, int height, FilmSums kind)
{
    if (int64_t(width) * height > kMaxPixels)
        throw EngineError(StatusCode::OutOfMemory, "the image has more than 2^28 pixels");
    const bool kept = width == _width && height == _height && kind == sumsKind();
    if (!kept)
    {
        _width = _height = _tilesX = _tilesY = 0;
        const int tilesX = (width + kTileSize - 1) / kTileSize;
        const int tilesY = (height + kTileSize - 1) / kTileSize;
        const auto tiles = static_cast<std::size_t>(tilesX) * static_cast<std::size_t>(tilesY);
        try
        {
            // Values are written before they are read, tile by tile: by the first pass of each
            // half.
            _sums = {};
            _exact = {};
            if (kind == FilmSums::Exact)
                _exact = ExactSums(tiles);
            else
                _sums = UnclearedArray<RgbaLanes>(tiles * 2 * kTileBlocks);
            _depth = UnclearedArray<float>(tiles * kTilePixels);
            _passes.assign(tiles * 2, 0);
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
    int least = tileCount() > 0 ? tilePasses(0) : 0;
    for (int tile = 1; tile < tileCount(); ++tile)
        least = std::min(least, tilePasses(tile));
    return least;
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
    const bool folds = sumsKind() == FilmSums::Fast && (next >> 1) % kFoldPasses == kFoldPasses - 1;
    if (folds && _totals.empty()) _totals.assign(_sums.size() * kChannels * kLanes, 0.0);
}

RgbaLanes* Film::firstPassStorage(int tile, int pass)
{
    const int half = pass & 1;
    const bool first = sumsKind() == FilmSums::Fast && halfPasses(tile, half) == 0;
    return first ? reinterpret_cast<RgbaLanes*>(sums(tile, half)) : nullptr;
}

int Film::addPass(int tile, int pass, const RgbaLanes* values)
{
    int leftOut = 0;
    const int half = pass & 1;
    if (sumsKind() == FilmSums::Exact)
        leftOut = _exact.add(static_cast<std::size_t>(tile), half, halfPasses(tile, half), values);
    else if (RgbaLanes* storage = firstPassStorage(tile, pass))
        std::copy(values, values + kTileBlocks, storage);
    else
        add(sums(tile, half), values[0].r.v);
    finishPass(tile, pass);
    return leftOut;
}

void Film::finishPass(int tile, int pass)
{
    const int half = pass & 1;
    const int passes = ++_passes[static_cast<std::size_t>(tile) * 2 + (pass & 1)];
    if (sumsKind() == FilmSums::Fast && passes % kFoldPasses == 0) fold(tile, half);
}

void Film::setHalf(int tile, int half, int passes, const ExactSum* sums)
{
    const auto t = static_cast<std::size_t>(tile);
    _passes[t * 2 + static_cast<std::size_t>(half)] = passes;
    for (std::size_t i = 0; i < ExactSums::kValues; ++i)
        _exact.set(t, half, i, sums[i]);
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
    const int count = halfPasses(tile, half);
    if (count == 0)
    {
        std::fill_n(floatsOf(values), kHalfFloats, 0.0f);
        return;
    }
    if (sumsKind() == FilmSums::Exact)
    {
        _exact.means(static_cast<std::size_t>(tile), half, count, floatsOf(values));
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
    if (halfPasses(tile, 0) == 0 || halfPasses(tile, 1) == 0)
    {
        halfMean(tile, halfPasses(tile, 0) == 0 ? 1 : 0, values);
        return;
    }
    if (sumsKind() == FilmSums::Exact)
    {
        _exact.means(static_cast<std::size_t>(tile), count, floatsOf(values));
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
    const int first = halfPasses(tile, 0), second = halfPasses(tile, 1);
    if (first == 0 || second == 0) return 0.0f;
    if (first == second) return 0.5f;
    if (std::abs(first - second) > 1)
    {
        // Parts of an image. Means of n and m passes have variances s^2 / n and s^2 / m, and that
        // of all has s^2 / (n + m).
        const double a = first, b = second;
        return static_cast<float>(std::sqrt(a * b) / (a + b));
    }
    // One half has n passes and a mean of variance V, the other half has one pass more, of variance
    // s^2 alone. V is s^2 / n for independent passes and down to s^2 / n^2 for points that fill the
    // square evenly, whose mean a last pass makes worse. The code takes s^2 / n^1.5, about 3 % of
    // variance from either.
    const double n = std::min(first, second), last = n * std::sqrt(n); // last: s^2 / V
    const double variance = (2.0 * n * n + last) / ((2.0 * n + 1.0) * (2.0 * n + 1.0));
    const double difference = (n * n + last) / ((n + 1.0) * (n + 1.0)) + 1.0;
    return static_cast<float>(std::sqrt(variance / difference));
}

} // namespace osgRayTrace::engine
