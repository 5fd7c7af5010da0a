// DenoisePixels.cpp - the denoiser's first step and its last: from pixels to cells and back. Layer:
// session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseCells.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kSegment = 256; ///< pixels of a row that are worked on while they are in the cache

/// Pixels that are almost not there have no light of their own.
constexpr float kLeastAlpha = 1e-3f;
constexpr float kLargestLight = 1e20f; ///< squares of it are finite

/// What a pixel has to give to its cell.
struct PixelLight
{
    float r[kSegment], g[kSegment], b[kSegment]; ///< times alpha; 0 if it has nothing to give
    float alpha[kSegment];                       ///< its weight; 0 if so
    float luminance[kSegment];                   ///< of its light
    float error[kSegment];                       ///< mean square
};

struct AlbedoRow
{
    const float *r, *g, *b;
};

OSGRAYTRACE_KERNEL
void divideByAlbedo(const float* rgba, AlbedoRow albedo, const uint8_t* inCell, int count,
                    PixelLight& out)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const float alpha = rgba[4 * i + 3];
        const float r = rgba[4 * i] / albedo.r[i], g = rgba[4 * i + 1] / albedo.g[i],
                    b = rgba[4 * i + 2] / albedo.b[i];
        const float luminance = luminanceOf(r, g, b);
        const uint32_t known = maskOf(inCell[i] != 0) & maskOf(alpha > kLeastAlpha) &
                               maskOf(alpha < 2.0f) & maskOf(std::fabs(luminance) < kLargestLight);
        out.r[i] = select(known, r, 0.0f);
        out.g[i] = select(known, g, 0.0f);
        out.b[i] = select(known, b, 0.0f);
        out.alpha[i] = select(known, alpha, 0.0f);
        out.luminance[i] = select(known, luminance / alpha, 0.0f);
        out.error[i] = 0.0f;
    }
}

/// Red, green and blue come from the same paths: their errors are taken to go together.
OSGRAYTRACE_KERNEL
void divideErrors(const float* errors, const float* rgba, AlbedoRow albedo, int count,
                  PixelLight& out)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const float error =
            luminanceOf(errors[3 * i] / albedo.r[i], errors[3 * i + 1] / albedo.g[i],
                        errors[3 * i + 2] / albedo.b[i]) /
            rgba[4 * i + 3];
        const uint32_t known =
            maskOf(out.alpha[i] > 0.0f) & maskOf(std::fabs(error) < kLargestLight);
        out.error[i] = select(known, error * error, 0.0f);
    }
}

void clearFrom(PixelLight& light, int count)
{
    for (float* values : {light.r, light.g, light.b, light.alpha, light.luminance, light.error})
        std::fill(values + count, values + kSegment, 0.0f);
}

struct CellRow
{
    float* __restrict r;
    float* __restrict g;
    float* __restrict b;
    float* __restrict mean;
    float* __restrict spread;
    float* __restrict error;
    float* __restrict variance;
};

OSGRAYTRACE_KERNEL
void addUp(const PixelLight& first, const PixelLight& second, int count, CellRow out)
{
    OSGRAYTRACE_SIMD
    for (int c = 0; c < count; ++c)
    {
        const float a0 = first.alpha[2 * c], a1 = first.alpha[2 * c + 1], a2 = second.alpha[2 * c],
                    a3 = second.alpha[2 * c + 1];
        const float l0 = first.luminance[2 * c], l1 = first.luminance[2 * c + 1],
                    l2 = second.luminance[2 * c], l3 = second.luminance[2 * c + 1];
        const float weight = (a0 + a1) + (a2 + a3);
        const uint32_t known = maskOf(weight > 0.0f);
        const float scale = 1.0f / select(known, weight, 1.0f);
        const float r = scale * ((first.r[2 * c] + first.r[2 * c + 1]) +
                                 (second.r[2 * c] + second.r[2 * c + 1]));
        const float g = scale * ((first.g[2 * c] + first.g[2 * c + 1]) +
                                 (second.g[2 * c] + second.g[2 * c + 1]));
        const float b = scale * ((first.b[2 * c] + first.b[2 * c + 1]) +
                                 (second.b[2 * c] + second.b[2 * c + 1]));
        const float mean = luminanceOf(r, g, b);
        const float spread = (a0 * (l0 - mean) * (l0 - mean) + a1 * (l1 - mean) * (l1 - mean)) +
                             (a2 * (l2 - mean) * (l2 - mean) + a3 * (l3 - mean) * (l3 - mean));
        const float errors = (a0 * first.error[2 * c] + a1 * first.error[2 * c + 1]) +
                             (a2 * second.error[2 * c] + a3 * second.error[2 * c + 1]);
        out.r[c] = select(known, r, kNoLight);
        out.g[c] = select(known, g, kNoLight);
        out.b[c] = select(known, b, kNoLight);
        out.mean[c] = select(known, mean, kNoLight);
        out.spread[c] = scale * spread;
        out.error[c] = scale * errors;
        out.variance[c] = scale * scale * errors;
    }
}

struct FilteredRow
{
    const float *r, *g, *b, *kept;
};

/// The light of a row's pixels, of those that take any.
struct Mixed
{
    float r[kSegment], g[kSegment], b[kSegment], kept[kSegment];
    float weight[kSegment];
};

struct WeightRow
{
    const uint8_t *near, *acrossX, *acrossY, *acrossBoth;
};

struct MixSums
{
    float r, g, b, kept, weight;
};

OSGRAYTRACE_INLINE void addCell(const FilteredRow& cells, int c, uint8_t likeness, MixSums& sums)
{
    const float r = cells.r[c];
    const uint32_t known = maskOf(r < 0.5f * kNoLight);
    const float weight = select(known, static_cast<float>(likeness), 0.0f);
    sums.r += weight * r;
    sums.g += weight * cells.g[c];
    sums.b += weight * cells.b[c];
    sums.kept += weight * cells.kept[c];
    sums.weight += weight;
}

/// The light of a pixel; side: of its cell that it is on.
OSGRAYTRACE_INLINE MixSums mixOf(const FilteredRow& cells, const FilteredRow& across,
                                 const WeightRow& weights, int c, int side)
{
    MixSums s{0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    addCell(cells, c, weights.near[c], s);
    addCell(cells, c + side, weights.acrossX[c], s);
    addCell(across, c, weights.acrossY[c], s);
    addCell(across, c + side, weights.acrossBoth[c], s);
    const float scale = s.weight > 0.0f ? 1.0f / s.weight : 0.0f;
    return {scale * s.r, scale * s.g, scale * s.b, scale * s.kept, s.weight};
}

OSGRAYTRACE_KERNEL
void mixCells(const FilteredRow& cells, const FilteredRow& across, const WeightRow& even,
              const WeightRow& odd, int count, Mixed& out)
{
    const FilteredRow n = cells, a = across;
    const WeightRow evens = even, odds = odd;
    OSGRAYTRACE_SIMD
    for (int c = 0; c < count; ++c)
    {
        const MixSums left = mixOf(n, a, evens, c, -1), right = mixOf(n, a, odds, c, 1);
        out.r[2 * c] = left.r;
        out.r[2 * c + 1] = right.r;
        out.g[2 * c] = left.g;
        out.g[2 * c + 1] = right.g;
        out.b[2 * c] = left.b;
        out.b[2 * c + 1] = right.b;
        out.kept[2 * c] = left.kept;
        out.kept[2 * c + 1] = right.kept;
        out.weight[2 * c] = left.weight;
        out.weight[2 * c + 1] = right.weight;
    }
}

OSGRAYTRACE_KERNEL
void multiplyByAlbedo(const Mixed& light, AlbedoRow albedo, int count, float* __restrict rgba)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const float r = rgba[4 * i], g = rgba[4 * i + 1], b = rgba[4 * i + 2],
                    alpha = rgba[4 * i + 3];
        const uint32_t filtered =
            maskOf(light.weight[i] > 0.0f) & maskOf(albedo.r[i] > 0.0f) &
            maskOf(alpha > kLeastAlpha) & maskOf(alpha < 2.0f) &
            maskOf(std::fabs(r) + std::fabs(g) + std::fabs(b) < kLargestLight);
        const float filteredR = alpha * albedo.r[i] * light.r[i],
                    filteredG = alpha * albedo.g[i] * light.g[i],
                    filteredB = alpha * albedo.b[i] * light.b[i], kept = light.kept[i];
        rgba[4 * i] = select(filtered, filteredR + kept * (r - filteredR), r);
        rgba[4 * i + 1] = select(filtered, filteredG + kept * (g - filteredG), g);
        rgba[4 * i + 2] = select(filtered, filteredB + kept * (b - filteredB), b);
        rgba[4 * i + 3] = alpha;
    }
}

AlbedoRow albedoRow(const DenoiseGuides& guides, int x, int y)
{
    return {guides.albedoR.row(y) + x, guides.albedoG.row(y) + x, guides.albedoB.row(y) + x};
}

FilteredRow filteredRow(const CellLight& light, const CellPlane& kept, int c, int y)
{
    return {light.r.row(y) + c, light.g.row(y) + c, light.b.row(y) + c, kept.row(y) + c};
}

std::size_t pixelOf(const ResolvedImage& image, int x, int y)
{
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
           static_cast<std::size_t>(x);
}

} // namespace

void gatherCells(const ResolvedImage& image, const DenoiseGuides& guides, int y, CellLight& light,
                 CellStatistics& statistics)
{
    const bool hasErrors = !image.error.empty();
    PixelLight rows[2];
    for (int x = 0; x < image.width; x += kSegment)
    {
        const int pixels = std::min(kSegment, image.width - x);
        for (int i = 0; i < 2; ++i)
        {
            const int row = 2 * y + i;
            const int count = row < image.height ? pixels : 0;
            if (count)
            {
                const float* rgba = &image.radiance[4 * pixelOf(image, x, row)];
                const AlbedoRow albedo = albedoRow(guides, x, row);
                divideByAlbedo(rgba, albedo, guides.inCell.row(row) + x, count, rows[i]);
                if (hasErrors)
                    divideErrors(&image.error[3 * pixelOf(image, x, row)], rgba, albedo, count,
                                 rows[i]);
            }
            if (count < kSegment) clearFrom(rows[i], count);
        }
        const int c = x / 2;
        addUp(rows[0], rows[1], (pixels + 1) / 2,
              {light.r.row(y) + c, light.g.row(y) + c, light.b.row(y) + c,
               statistics.mean.row(y) + c, statistics.spread.row(y) + c,
               statistics.error.row(y) + c, statistics.variance.row(y) + c});
    }
}

void spreadCells(const DenoiseGuides& guides, const CellLight& filtered, const CellPlane& kept,
                 int y, ResolvedImage& image)
{
    Mixed mixed;
    const int next = (y & 1) ? y / 2 + 1 : y / 2 - 1;
    for (int x = 0; x < image.width; x += kSegment)
    {
        const int pixels = std::min(kSegment, image.width - x), c = x / 2;
        const auto weights = [&](int first)
        {
            return WeightRow{guides.near.row(y) + first, guides.acrossX.row(y) + first,
                             guides.acrossY.row(y) + first, guides.acrossBoth.row(y) + first};
        };
        mixCells(filteredRow(filtered, kept, c, y / 2), filteredRow(filtered, kept, c, next),
                 weights(c), weights(guides.cellsX + c), (pixels + 1) / 2, mixed);
        multiplyByAlbedo(mixed, albedoRow(guides, x, y), pixels,
                         &image.radiance[4 * pixelOf(image, x, y)]);
    }
}

} // namespace osgRayTrace::engine
