// DenoiseGather.cpp - the first step of the denoiser: from pixels to cells. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseAlbedo.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Holds the light that pixels give to their cells.
struct PixelLight
{
    float r[kPixelSegment], g[kPixelSegment],
        b[kPixelSegment];           ///< light times alpha; 0 if the pixel has nothing to give
    float alpha[kPixelSegment];     ///< weight of the pixel; 0 if it has nothing to give
    float luminance[kPixelSegment]; ///< luminance of the light
    float error[kPixelSegment];     ///< mean square error of the luminance
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

/// Divides the errors by the albedo. Red, green and blue come from the same paths, so their errors
/// are taken to go together.
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
        std::fill(values + count, values + kPixelSegment, 0.0f);
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

} // namespace

void gatherCells(const ResolvedImage& image, const DenoiseGuides& guides, int y, CellLight& light,
                 CellStatistics& statistics)
{
    const bool hasErrors = !image.error.empty();
    PixelLight rows[2];
    for (int x = 0; x < image.width; x += kPixelSegment)
    {
        const int pixels = std::min(kPixelSegment, image.width - x);
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
            if (count < kPixelSegment) clearFrom(rows[i], count);
        }
        const int c = x / 2;
        addUp(rows[0], rows[1], (pixels + 1) / 2,
              {light.r.row(y) + c, light.g.row(y) + c, light.b.row(y) + c,
               statistics.mean.row(y) + c, statistics.spread.row(y) + c,
               statistics.error.row(y) + c, statistics.variance.row(y) + c});
    }
}

} // namespace osgRayTrace::engine
