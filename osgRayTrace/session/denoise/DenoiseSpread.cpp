// DenoiseSpread.cpp - the last step of the denoiser: from cells to pixels. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseAlbedo.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

struct FilteredRow
{
    const float *r, *g, *b, *kept;
};

/// Holds the filtered light of those pixels of a row that take any.
struct Mixed
{
    float r[kPixelSegment], g[kPixelSegment], b[kPixelSegment], kept[kPixelSegment];
    float weight[kPixelSegment];
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

/// Returns the sums for the light of a pixel. side: the side of its cell that the pixel is on.
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

FilteredRow filteredRow(const CellLight& light, const CellPlane& kept, int c, int y)
{
    return {light.r.row(y) + c, light.g.row(y) + c, light.b.row(y) + c, kept.row(y) + c};
}

} // namespace

void spreadCells(const DenoiseGuides& guides, const CellLight& filtered, const CellPlane& kept,
                 int y, ResolvedImage& image)
{
    Mixed mixed;
    const int next = (y & 1) ? y / 2 + 1 : y / 2 - 1;
    for (int x = 0; x < image.width; x += kPixelSegment)
    {
        const int pixels = std::min(kPixelSegment, image.width - x), c = x / 2;
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
