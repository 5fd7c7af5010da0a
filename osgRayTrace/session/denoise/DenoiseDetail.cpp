// DenoiseDetail.cpp - the share of the image's own light that the denoiser keeps. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseTaps.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Errors and the differences that they have to explain are summed over 7 x 7 cells. An error of
/// two halves is one random number, so the errors of fewer pixels are no measure. Errors count for
/// a little more, as detail that is kept by mistake is seen more easily than detail that is lost.
constexpr int kReach = 3;
constexpr float kDoubt = 1.25f;

/// Adds the squared difference of the filtered light from the mean to spread. Cells without known
/// light count nothing.
OSGRAYTRACE_KERNEL
void residualRow(const float* means, LightTap light, int count, float* __restrict spread)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const float difference = luminanceOf(light.r[i], light.g[i], light.b[i]) - means[i];
        const uint32_t known = maskOf(means[i] < 0.5f * kNoLight);
        spread[i] = select(known, difference * difference + spread[i], 0.0f);
    }
}

constexpr int kSegment = 256; ///< cells that are worked on while they are in the cache

struct Column
{
    float residual[kSegment + 2 * kReach], error[kSegment + 2 * kReach];
};

/// Sums the columns of the neighbourhood, from kReach cells before the first cell on.
OSGRAYTRACE_KERNEL
void sumColumns(const float* const (&residuals)[2 * kReach + 1],
                const float* const (&errors)[2 * kReach + 1], int count, Column& column)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count + 2 * kReach; ++i)
    {
        float residual = 0.0f, error = 0.0f;
        for (int row = 0; row < 2 * kReach + 1; ++row)
        {
            residual += residuals[row][i];
            error += errors[row][i];
        }
        column.residual[i] = residual;
        column.error[i] = error;
    }
}

OSGRAYTRACE_KERNEL
void keepRow(const Column& column, int count, float* __restrict kept)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        float residual = 0.0f, error = 0.0f;
        for (int j = 0; j < 2 * kReach + 1; ++j)
        {
            residual += column.residual[i + j];
            error += column.error[i + j];
        }
        const float k = 1.0f - kDoubt * error / (residual + 1e-30f);
        kept[i] = k > 0.0f ? k : 0.0f;
    }
}

} // namespace

void compareCells(const DenoiseGuides& guides, const CellLight& filtered, int y,
                  CellStatistics& statistics)
{
    residualRow(statistics.mean.row(y), lightTap(filtered, y), guides.cellsX,
                statistics.spread.row(y));
}

void keepDetail(const DenoiseGuides& guides, const CellStatistics& statistics, int y,
                CellPlane& kept)
{
    Column column;
    for (int x = 0; x < guides.cellsX; x += kSegment)
    {
        const float *residuals[2 * kReach + 1], *errors[2 * kReach + 1];
        for (int i = 0; i < 2 * kReach + 1; ++i)
        {
            residuals[i] = statistics.spread.row(y + i - kReach) + x - kReach;
            errors[i] = statistics.error.row(y + i - kReach) + x - kReach;
        }
        const int count = std::min(kSegment, guides.cellsX - x);
        sumColumns(residuals, errors, count, column);
        keepRow(column, count, kept.row(y) + x);
    }
}

} // namespace osgRayTrace::engine
