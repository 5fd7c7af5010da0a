// DenoiseGuides.cpp - the surfaces of the pixels, as the denoiser's loops read them. Layer:
// session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseGuides.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/denoise/DenoiseSurfaces.h"
#include "osgRayTrace/session/denoise/DenoiseWeights.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Allowed change of a slope, as a share of the slope.
constexpr float kSlopeTolerance = 0.5f;

/// Returns the smaller of the differences to both sides, as the difference over an edge is larger.
OSGRAYTRACE_INLINE float slopeOf(float before, float here, float after)
{
    const float a = here - before, b = after - here;
    const float slope = std::fabs(a) < std::fabs(b) ? a : b;
    return std::fabs(slope) < 0.5f * kNoSurface ? slope : 0.0f;
}

OSGRAYTRACE_KERNEL
void makeSlopes(const float* above, const float* here, const float* below, int count,
                float* __restrict slopeX, float* __restrict slopeY, float* __restrict sharpness)
{
    OSGRAYTRACE_SIMD
    for (int c = 0; c < count; ++c)
    {
        const float x = slopeOf(here[c - 1], here[c], here[c + 1]);
        const float y = slopeOf(below[c], here[c], above[c]);
        slopeX[c] = x;
        slopeY[c] = y;
        sharpness[c] = 1.0f / (kDistanceTolerance * here[c] +
                               kSlopeTolerance * (std::fabs(x) + std::fabs(y)) + 1e-30f);
    }
}

GuideRow guideRow(const CellGuides& cells, int y)
{
    return {cells.normalX.row(y),  cells.normalY.row(y), cells.normalZ.row(y),
            cells.distance.row(y), cells.slopeX.row(y),  cells.slopeY.row(y),
            cells.sharpness.row(y)};
}

/// Makes the guides of one row after the other, for pixels or for cells.
struct GuideMaker
{
    DenoiseGuides& guides;
    const std::vector<SurfaceSample>& surfaces;

    const SurfaceSample* samplesAt(int x, int y) const
    {
        return &surfaces[static_cast<std::size_t>(y) * static_cast<std::size_t>(guides.width) +
                         static_cast<std::size_t>(x)];
    }

    /// Unpacks a segment of row y, from column x on. Returns the number of pixels that the segment
    /// has.
    int unpackAt(Surfaces& s, int row, int x, int y) const
    {
        const int count = y < guides.height ? std::min(kSurfaceSegment, guides.width - x) : 0;
        const int inside = std::min(y, guides.height - 1);
        const auto scatters = [&](int above)
        { return guides.scatters.row(inside + above) + x + 1; };
        unpack(samplesAt(x, inside), {scatters(0), scatters(1), scatters(2)}, count, rowOf(s, row));
        return count;
    }

    void findScatteringOf(int y) const
    {
        findScattering(samplesAt(0, y), guides.width, guides.scatters.row(y + 1) + 1);
    }

    void makeCellsOf(int row) const
    {
        Surfaces s;
        CellGuides& cells = guides.cells;
        for (int x = 0; x < guides.width; x += kSurfaceSegment)
        {
            for (int i = 0; i < 2; ++i)
            {
                const int y = 2 * row + i, count = unpackAt(s, i, x, y);
                if (count)
                    unpackAlbedo(samplesAt(x, y), s.distance[i], count, guides.albedoR.row(y) + x,
                                 guides.albedoG.row(y) + x, guides.albedoB.row(y) + x);
            }
            const int c = x / 2;
            makeCells(s, std::min(kSurfaceSegment / 2, guides.cellsX - c),
                      {cells.normalX.row(row) + c, cells.normalY.row(row) + c,
                       cells.normalZ.row(row) + c, cells.distance.row(row) + c},
                      guides.inCell.row(2 * row) + x, guides.inCell.row(2 * row + 1) + x);
        }
    }

    void makeSlopesOf(int y) const
    {
        CellGuides& cells = guides.cells;
        makeSlopes(cells.distance.row(y + 1), cells.distance.row(y), cells.distance.row(y - 1),
                   guides.cellsX, cells.slopeX.row(y), cells.slopeY.row(y), cells.sharpness.row(y));
    }

    void weighCellsOf(int y) const
    {
        const int side = 2 * (y & 1) - 1;
        Surfaces s;
        for (int x = 0; x < guides.width; x += kSurfaceSegment)
        {
            unpackAt(s, 0, x, y);
            const int c = x / 2;
            const auto weights = [&](int first)
            {
                return WeightRow{guides.near.row(y) + first, guides.acrossX.row(y) + first,
                                 guides.acrossY.row(y) + first, guides.acrossBoth.row(y) + first};
            };
            weighCells(rowOf(s, 0), {c, std::min(kSurfaceSegment / 2, guides.cellsX - c)},
                       0.25f * static_cast<float>(side), guideRow(guides.cells, y / 2),
                       guideRow(guides.cells, y / 2 + side), weights(c),
                       weights(guides.cellsX + c));
        }
    }
};

} // namespace

void DenoiseGuides::allocate(int pixelsX, int pixelsY)
{
    if (width == pixelsX && height == pixelsY) return;
    width = height = 0; // no size is valid if memory runs out below
    cellsX = (pixelsX + 1) / 2;
    cellsY = (pixelsY + 1) / 2;
    for (PixelPlane<float>* plane : {&albedoR, &albedoG, &albedoB})
        plane->allocate(pixelsX, pixelsY);
    // These planes hold rows of whole cells.
    for (PixelPlane<uint8_t>* plane : {&inCell, &near, &acrossX, &acrossY, &acrossBoth})
        plane->allocate(2 * cellsX, 2 * cellsY);
    // The margin has pixels of which nothing is known and that hide nothing.
    scatters.allocate(pixelsX + 2, pixelsY + 2);
    for (int y = 0; y < pixelsY + 2; ++y)
        std::fill_n(scatters.row(y), pixelsX + 2, uint8_t(1));
    for (CellPlane* plane : {&cells.normalX, &cells.normalY, &cells.normalZ, &cells.slopeX,
                             &cells.slopeY, &cells.sharpness})
        plane->allocate(cellsX, cellsY, 0.0f);
    cells.distance.allocate(cellsX, cellsY, kNoSurface);
    width = pixelsX;
    height = pixelsY;
}

void DenoiseGuides::set(const std::vector<SurfaceSample>& surfaces, int pixelsX, int pixelsY,
                        const Workers& workers)
{
    allocate(pixelsX, pixelsY);
    const GuideMaker maker{*this, surfaces};
    const auto pixelRows = static_cast<std::size_t>(height);
    const auto cellRows = static_cast<std::size_t>(cellsY);
    workers.forEach(pixelRows, [&](std::size_t y) { maker.findScatteringOf(static_cast<int>(y)); });
    workers.forEach(cellRows, [&](std::size_t y) { maker.makeCellsOf(static_cast<int>(y)); });
    workers.forEach(cellRows, [&](std::size_t y) { maker.makeSlopesOf(static_cast<int>(y)); });
    workers.forEach(pixelRows, [&](std::size_t y) { maker.weighCellsOf(static_cast<int>(y)); });
}

} // namespace osgRayTrace::engine
