// Resolve.cpp - images in rows of pixels from the film's tiles. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/Resolve.h"

#include "osgRayTrace/film/PowerLanes.h"
#include "osgRayTrace/film/ToneCurves.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the sRGB encoding of a value in [0,1].
OSGRAYTRACE_INLINE float encodeLanes(float x)
{
    const float power =
        1.055f * exp2Lanes(log2Lanes(x < 1e-4f ? 1e-4f : x) * (1.0f / 2.4f)) - 0.055f;
    return select(x <= 0.0031308f, 12.92f * x, power);
}

OSGRAYTRACE_INLINE float clampUnit(float x)
{
    // The first comparison is false for NaN, which becomes 0.
    const float positive = x > 0.0f ? x : 0.0f;
    return positive < 1.0f ? positive : 1.0f;
}

OSGRAYTRACE_INLINE uint32_t packLane(float r, float g, float b, float a)
{
    return static_cast<uint32_t>(static_cast<int>(r * 255.0f + 0.5f)) |
           static_cast<uint32_t>(static_cast<int>(g * 255.0f + 0.5f)) << 8 |
           static_cast<uint32_t>(static_cast<int>(b * 255.0f + 0.5f)) << 16 |
           static_cast<uint32_t>(static_cast<int>(a * 255.0f + 0.5f)) << 24;
}

OSGRAYTRACE_KERNEL
void packDisplay(const RgbaLanes* __restrict blocks, UintLanes* __restrict packed)
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
            packed[b][i] = packLane(clampUnit(blocks[b].r[i]), clampUnit(blocks[b].g[i]),
                                    clampUnit(blocks[b].b[i]), clampUnit(blocks[b].a[i]));
    }
}

/// Packs alpha * encode(radiance), which a display blends, from the film's alpha * radiance.
OSGRAYTRACE_KERNEL
void packEncoded(const RgbaLanes* __restrict blocks, float exposure, UintLanes* __restrict packed)
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
        {
            const float alpha = clampUnit(blocks[b].a[i]);
            const float scale = exposure / (alpha > 0.0f ? alpha : 1.0f);
            packed[b][i] = packLane(alpha * encodeLanes(clampUnit(blocks[b].r[i] * scale)),
                                    alpha * encodeLanes(clampUnit(blocks[b].g[i] * scale)),
                                    alpha * encodeLanes(clampUnit(blocks[b].b[i] * scale)), alpha);
        }
    }
}

/// Returns the integer that is nearest to 255 times a value in [0,1].
OSGRAYTRACE_INLINE int byteLane(float x)
{
    return static_cast<int>(x * 255.0f + 0.5f);
}

/// Returns a channel of ToneMap's D for alpha = 1 - through / 255. Displays round what they blend:
/// with the rounding of blendOver, the sum is the rounded encoding.
OSGRAYTRACE_INLINE int overVeiled(float shown, float left, int through, float linear, int display)
{
    const int sum = byteLane(encodeLanes(clampUnit(shown + left * linear)));
    const int rest = sum - (through * display + 127) / 255;
    return rest > 0 ? rest : 0;
}

struct Background
{
    float linear[3];
    int display[3]; ///< 0 .. 255
};

Background backgroundOf(const ToneMap& toneMap)
{
    Background background = {};
    for (int c = 0; c < 3; ++c)
    {
        background.display[c] = byteLane(clampUnit(toneMap.background[c]));
        background.linear[c] =
            linearFromSrgb(static_cast<float>(background.display[c]) * (1.0f / 255.0f));
    }
    return background;
}

/// Packs what a display blends over a veiled background, see ToneMap. Displays blend nothing of an
/// alpha of 0: light in air that is as thin as that gets the least alpha.
OSGRAYTRACE_KERNEL
void packVeiled(const RgbaLanes* __restrict blocks, float exposure, const Background& background,
                UintLanes* __restrict packed)
{
    const float* linear = background.linear;
    const int* display = background.display;
    for (int b = 0; b < kTileBlocks; ++b)
    {
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
        {
            const float alpha = clampUnit(blocks[b].a[i]), left = 1.0f - alpha;
            const float r = clampUnit(blocks[b].r[i] * exposure),
                        g = clampUnit(blocks[b].g[i] * exposure),
                        blue = clampUnit(blocks[b].b[i] * exposure);
            const int some = r + g + blue > 0.0f ? 1 : 0;
            const int rounded = byteLane(alpha);
            const int cover = rounded > some ? rounded : some, through = 255 - cover;
            packed[b][i] =
                static_cast<uint32_t>(overVeiled(r, left, through, linear[0], display[0])) |
                static_cast<uint32_t>(overVeiled(g, left, through, linear[1], display[1])) << 8 |
                static_cast<uint32_t>(overVeiled(blue, left, through, linear[2], display[2]))
                    << 16 |
                static_cast<uint32_t>(cover) << 24;
        }
    }
}

/// Applies the curve to the light before a veiled background, which is not divided by alpha.
void applyVeiledCurve(ToneCurve curve, float exposure, TileRgba& values)
{
    float alphas[kTileBlocks][kLanes];
    for (int b = 0; b < kTileBlocks; ++b)
        for (int i = 0; i < kLanes; ++i)
            alphas[b][i] = std::exchange(values[b].a[i], 1.0f);
    applyCurve(curve, exposure, values);
    for (int b = 0; b < kTileBlocks; ++b)
        for (int i = 0; i < kLanes; ++i)
            values[b].a[i] = alphas[b][i];
}

/// Packs linear radiance as the tone map shows it; values are overwritten.
void packShown(const ToneMap& toneMap, TileRgba& values, UintLanes* packed)
{
    const float exposure = std::exp2(toneMap.exposureEv);
    if (toneMap.veiled && !toneMap.displayReferred)
    {
        const bool curved = toneMap.curve != ToneCurve::Srgb;
        if (curved) applyVeiledCurve(toneMap.curve, exposure, values);
        packVeiled(values, curved ? 1.0f : exposure, backgroundOf(toneMap), packed);
        return;
    }
    if (toneMap.curve != ToneCurve::Srgb) applyCurve(toneMap.curve, exposure, values);
    packEncoded(values, toneMap.curve == ToneCurve::Srgb ? exposure : 1.0f, packed);
}

/// Returns a decoded value, limited to the range of float: a value that was shown as white anyway
/// may be too large for linear light.
float decoded(float encoded, float alpha)
{
    constexpr float kLargest = std::numeric_limits<float>::max();
    return std::clamp(alpha * linearFromSrgb(encoded / alpha), -kLargest, kLargest);
}

/// Calls write(image pixel index, block, lane) for each pixel of the tile inside the image.
template <class Write> void forEachPixel(const Film& film, int tile, const Write& write)
{
    const int left = film.tileX(tile), bottom = film.tileY(tile);
    const int columns = std::min(kTileSize, film.width() - left);
    const int rows = std::min(kTileSize, film.height() - bottom);
    for (int y = 0; y < rows; ++y)
    {
        const std::size_t row =
            static_cast<std::size_t>(bottom + y) * static_cast<std::size_t>(film.width()) +
            static_cast<std::size_t>(left);
        for (int x = 0; x < columns; ++x)
            write(row + static_cast<std::size_t>(x), (y >> 2) * 4 + (x >> 2),
                  (y & 3) * 4 + (x & 3));
    }
}

bool isWhole(const Film& film, int tile)
{
    return film.tileX(tile) + kTileSize <= film.width() &&
           film.tileY(tile) + kTileSize <= film.height();
}

/// Copies the lanes of a tile to the image. The four values of each row of each block are
/// neighbours in the image and are copied together.
template <class T> void copyRows(const Film& film, int tile, const T* lanes, T* image)
{
    if (!isWhole(film, tile))
    {
        forEachPixel(film, tile,
                     [&](std::size_t pixel, int block, int lane)
                     { image[pixel] = lanes[block * kLanes + lane]; });
        return;
    }
    const auto width = static_cast<std::size_t>(film.width());
    T* corner = image + static_cast<std::size_t>(film.tileY(tile)) * width + film.tileX(tile);
    for (int y = 0; y < kTileSize; ++y)
        for (int bx = 0; bx < 4; ++bx)
            std::memcpy(corner + static_cast<std::size_t>(y) * width + bx * 4,
                        lanes + ((y >> 2) * 4 + bx) * kLanes + (y & 3) * 4, 4 * sizeof(T));
}

/// Stands for a tile that has no pass yet, in which nothing is seen.
struct FarTile
{
    FarTile() { std::fill(std::begin(depth), std::end(depth), 1.0f); }
    float depth[kTilePixels];
};

const float* depthOf(const Film& film, int tile)
{
    static const FarTile far;
    return film.hasDepth(tile) ? film.depth(tile) : far.depth;
}

} // namespace

void decode(TileRgba& values)
{
    for (RgbaLanes& block : values)
    {
        for (int i = 0; i < kLanes; ++i)
        {
            const float alpha = block.a[i] > 0.0f ? block.a[i] : 1.0f;
            block.r[i] = decoded(block.r[i], alpha);
            block.g[i] = decoded(block.g[i], alpha);
            block.b[i] = decoded(block.b[i], alpha);
        }
    }
}

void resolveTileRadiance(const Film& film, int tile, bool displayReferred, float* image)
{
    TileRgba values;
    film.mean(tile, values);
    if (displayReferred) decode(values);
    forEachPixel(film, tile,
                 [&](std::size_t pixel, int block, int lane)
                 {
                     float* out = image + 4 * pixel;
                     out[0] = values[block].r[lane];
                     out[1] = values[block].g[lane];
                     out[2] = values[block].b[lane];
                     out[3] = values[block].a[lane];
                 });
}

void resolveTileDisplay(const Film& film, int tile, const ToneMap& toneMap, uint8_t* image,
                        float* depth)
{
    TileRgba values;
    UintLanes packed[kTileBlocks];
    film.mean(tile, values);
    const bool asIs =
        toneMap.displayReferred && toneMap.exposureEv == 0.0f && toneMap.curve == ToneCurve::Srgb;
    if (toneMap.displayReferred && !asIs) decode(values);
    if (asIs)
        packDisplay(values, packed);
    else
        packShown(toneMap, values, packed);
    copyRows(film, tile, packed[0].v, reinterpret_cast<uint32_t*>(image));
    if (depth) copyRows(film, tile, depthOf(film, tile), depth);
}

namespace
{

OSGRAYTRACE_KERNEL
void splitPixels(const float* __restrict rgba, int count, RgbaLanes& __restrict block)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        block.r[i] = rgba[4 * i];
        block.g[i] = rgba[4 * i + 1];
        block.b[i] = rgba[4 * i + 2];
        block.a[i] = rgba[4 * i + 3];
    }
}

} // namespace

void displayPixels(const float* rgba, std::size_t count, const ToneMap& toneMap, uint8_t* image)
{
    TileRgba values = {};
    UintLanes packed[kTileBlocks];
    for (std::size_t first = 0; first < count; first += kTilePixels)
    {
        const std::size_t pixels = std::min<std::size_t>(kTilePixels, count - first);
        const std::size_t whole = pixels / kLanes;
        for (std::size_t b = 0; b < whole; ++b)
            splitPixels(rgba + 4 * (first + b * kLanes), kLanes, values[b]);
        if (whole < kTileBlocks)
            splitPixels(rgba + 4 * (first + whole * kLanes),
                        static_cast<int>(pixels - whole * kLanes), values[whole]);
        packShown(toneMap, values, packed);
        std::memcpy(image + 4 * first, packed, 4 * pixels);
    }
}

void displayOver(const float* rgba, const uint8_t* behind, std::size_t count,
                 const ToneMap& toneMap, uint8_t* image)
{
    const bool curved = toneMap.curve != ToneCurve::Srgb;
    const float exposure = std::exp2(toneMap.exposureEv), scale = curved ? 1.0f : exposure;
    TileRgba values = {};
    for (std::size_t first = 0; first < count; first += kTilePixels)
    {
        const std::size_t pixels = std::min<std::size_t>(kTilePixels, count - first);
        for (std::size_t p = 0; p < pixels; p += kLanes)
            splitPixels(rgba + 4 * (first + p),
                        static_cast<int>(std::min<std::size_t>(kLanes, pixels - p)),
                        values[p / kLanes]);
        if (curved) applyVeiledCurve(toneMap.curve, exposure, values);
        for (std::size_t p = 0; p < pixels; ++p)
        {
            const RgbaLanes& block = values[p / kLanes];
            const std::size_t i = p % kLanes, at = 4 * (first + p);
            const float left = 1.0f - clampUnit(block.a[i]);
            const float light[3] = {block.r[i], block.g[i], block.b[i]};
            for (std::size_t c = 0; c < 3; ++c)
                image[at + c] = static_cast<uint8_t>(byteLane(encodeLanes(clampUnit(
                    clampUnit(light[c] * scale) +
                    left * linearFromSrgb(static_cast<float>(behind[at + c]) * (1.0f / 255.0f))))));
            image[at + 3] = 255;
        }
    }
}

void resolveTileDepth(const Film& film, int tile, float* depth)
{
    copyRows(film, tile, depthOf(film, tile), depth);
}

void resolveTileError(const Film& film, int tile, bool displayReferred, float* image)
{
    TileRgba first, second;
    film.halfMeans(tile, first, second);
    const float scale = film.errorScale(tile);
    if (displayReferred)
    {
        decode(first);
        decode(second);
    }
    forEachPixel(film, tile,
                 [&](std::size_t pixel, int block, int lane)
                 {
                     float* out = image + 3 * pixel;
                     out[0] = scale * std::fabs(first[block].r[lane] - second[block].r[lane]);
                     out[1] = scale * std::fabs(first[block].g[lane] - second[block].g[lane]);
                     out[2] = scale * std::fabs(first[block].b[lane] - second[block].b[lane]);
                 });
}

} // namespace osgRayTrace::engine
