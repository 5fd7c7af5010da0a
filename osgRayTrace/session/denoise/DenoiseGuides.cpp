// DenoiseGuides.cpp - what is seen in the pixels, as the denoiser's loops read it. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseGuides.h"

#include "osgRayTrace/base/Parallel.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kSegment = 256; ///< pixels of two rows that are worked on while they are in the cache

/// Below this, light over albedo would be more noise than light.
constexpr float kLeastAlbedo = 0.02f;

/// How far distances on one surface may be from those on a plane: this much of the distance, and of
/// what the plane changes from cell to cell.
constexpr float kDistanceTolerance = 0.01f;
constexpr float kSlopeTolerance = 0.5f;

/// One array for each quantity, for pixels of two rows.
struct Surfaces
{
    float normalX[2][kSegment], normalY[2][kSegment], normalZ[2][kSegment];
    float distance[2][kSegment];
};

/// 1 for pixels whose surface scatters the light that is seen there, and is finite.
OSGRAYTRACE_KERNEL
void findScattering(const SurfaceSample* samples, int count, uint8_t* __restrict scatters)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const SurfaceSample& s = samples[i];
        const float length =
            s.normal.x * s.normal.x + s.normal.y * s.normal.y + s.normal.z * s.normal.z;
        const uint32_t known = maskOf(s.kind == SurfaceKind::Scattering) &
                               maskOf(s.distance < kNoSurface) & maskOf(length > 0.5f) &
                               maskOf(length < 2.0f) &
                               maskOf(s.albedo.x + s.albedo.y + s.albedo.z < kNoSurface);
        scatters[i] = static_cast<uint8_t>(known & 1u);
    }
}

/// The surfaces of a row of pixels or of cells.
struct SurfaceRow
{
    float* __restrict normalX;
    float* __restrict normalY;
    float* __restrict normalZ;
    float* __restrict distance;
};

SurfaceRow rowOf(Surfaces& s, int row)
{
    return {s.normalX[row], s.normalY[row], s.normalZ[row], s.distance[row]};
}

/// Three rows of findScattering. The pixels before the first and past the last are looked at.
struct ScatterRows
{
    const uint8_t *below, *here, *above;
};

/// Unpacks the surfaces of one row. Pixels past its end have no surface. A pixel beside one that
/// does not scatter has none either: it may show some of a lamp or of the sky.
OSGRAYTRACE_KERNEL
void unpack(const SurfaceSample* samples, ScatterRows scatters, int count, SurfaceRow row)
{
    const uint8_t *below = scatters.below, *here = scatters.here, *above = scatters.above;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const SurfaceSample& s = samples[i];
        const int scattering = below[i - 1] & below[i] & below[i + 1] & here[i - 1] & here[i] &
                               here[i + 1] & above[i - 1] & above[i] & above[i + 1];
        const uint32_t known = maskOf(scattering != 0);
        row.normalX[i] = select(known, s.normal.x, 0.0f);
        row.normalY[i] = select(known, s.normal.y, 0.0f);
        row.normalZ[i] = select(known, s.normal.z, 0.0f);
        row.distance[i] = select(known, s.distance, kNoSurface);
    }
    for (int i = count; i < kSegment; ++i)
    {
        row.normalX[i] = row.normalY[i] = row.normalZ[i] = 0.0f;
        row.distance[i] = kNoSurface;
    }
}

OSGRAYTRACE_KERNEL
void unpackAlbedo(const SurfaceSample* samples, const float* distance, int count,
                  float* __restrict r, float* __restrict g, float* __restrict b)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const SurfaceSample& s = samples[i];
        const uint32_t known = maskOf(distance[i] < kNoSurface);
        r[i] = select(known, s.albedo.x > kLeastAlbedo ? s.albedo.x : kLeastAlbedo, 0.0f);
        g[i] = select(known, s.albedo.y > kLeastAlbedo ? s.albedo.y : kLeastAlbedo, 0.0f);
        b[i] = select(known, s.albedo.z > kLeastAlbedo ? s.albedo.z : kLeastAlbedo, 0.0f);
    }
}

/// The means over those pixels that show the same as the first that shows anything.
OSGRAYTRACE_KERNEL
void makeCells(const Surfaces& s, int count, SurfaceRow cells, uint8_t* __restrict inCell0,
               uint8_t* __restrict inCell1)
{
    constexpr float kAlike = 2.0f; // of fallOff's argument: normals within 10 degrees
    OSGRAYTRACE_SIMD
    for (int c = 0; c < count; ++c)
    {
        const float nx[4] = {s.normalX[0][2 * c], s.normalX[0][2 * c + 1], s.normalX[1][2 * c],
                             s.normalX[1][2 * c + 1]};
        const float ny[4] = {s.normalY[0][2 * c], s.normalY[0][2 * c + 1], s.normalY[1][2 * c],
                             s.normalY[1][2 * c + 1]};
        const float nz[4] = {s.normalZ[0][2 * c], s.normalZ[0][2 * c + 1], s.normalZ[1][2 * c],
                             s.normalZ[1][2 * c + 1]};
        const float d[4] = {s.distance[0][2 * c], s.distance[0][2 * c + 1], s.distance[1][2 * c],
                            s.distance[1][2 * c + 1]};
        float fx = nx[3], fy = ny[3], fz = nz[3], fd = d[3];
        for (int i = 2; i >= 0; --i)
        {
            const uint32_t known = maskOf(d[i] < kNoSurface);
            fx = select(known, nx[i], fx);
            fy = select(known, ny[i], fy);
            fz = select(known, nz[i], fz);
            fd = select(known, d[i], fd);
        }
        float sumX = 0.0f, sumY = 0.0f, sumZ = 0.0f, sumD = 0.0f, sum = 0.0f;
        float share[4];
        for (int i = 0; i < 4; ++i)
        {
            const uint32_t same = maskOf(d[i] < kNoSurface) &
                                  maskOf(normalDistance(fx, fy, fz, nx[i], ny[i], nz[i]) < kAlike) &
                                  maskOf(std::fabs(d[i] - fd) < 5.0f * kDistanceTolerance * fd);
            share[i] = select(same, 1.0f, 0.0f);
            sumX += share[i] * nx[i];
            sumY += share[i] * ny[i];
            sumZ += share[i] * nz[i];
            sumD += select(same, d[i], 0.0f);
            sum += share[i];
        }
        const float length = std::sqrt(sumX * sumX + sumY * sumY + sumZ * sumZ);
        const float scale = length > 0.0f ? 1.0f / length : 0.0f;
        cells.normalX[c] = sumX * scale;
        cells.normalY[c] = sumY * scale;
        cells.normalZ[c] = sumZ * scale;
        cells.distance[c] = sum > 0.0f ? sumD / sum : kNoSurface;
        inCell0[2 * c] = static_cast<uint8_t>(share[0]);
        inCell0[2 * c + 1] = static_cast<uint8_t>(share[1]);
        inCell1[2 * c] = static_cast<uint8_t>(share[2]);
        inCell1[2 * c + 1] = static_cast<uint8_t>(share[3]);
    }
}

/// The smaller of the differences to both sides: that over an edge is larger.
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

/// A row of cells as the pixels beside it see them.
struct GuideRow
{
    const float *normalX, *normalY, *normalZ, *distance, *slopeX, *slopeY, *sharpness;
};

GuideRow guideRow(const CellGuides& cells, int y)
{
    return {cells.normalX.row(y),  cells.normalY.row(y), cells.normalZ.row(y),
            cells.distance.row(y), cells.slopeX.row(y),  cells.slopeY.row(y),
            cells.sharpness.row(y)};
}

/// What is at a pixel.
struct PixelSurface
{
    float normalX, normalY, normalZ, distance;
};

/// c: a cell at most one off the picture, where none has a surface. offsetX, offsetY: of the pixel
/// from its middle, in cells. As a number of 28 * most at most.
OSGRAYTRACE_INLINE uint8_t likeness(const PixelSurface& p, const GuideRow& cells, int c,
                                    float offsetX, float offsetY, float most)
{
    const float plane = cells.distance[c] + offsetX * cells.slopeX[c] + offsetY * cells.slopeY[c];
    const float alike = fallOff(std::fabs(p.distance - plane) * cells.sharpness[c] +
                                normalDistance(p.normalX, p.normalY, p.normalZ, cells.normalX[c],
                                               cells.normalY[c], cells.normalZ[c]));
    const float known = p.distance < kNoSurface ? 28.0f : 0.0f;
    return static_cast<uint8_t>(static_cast<int>(known * most * alike + 0.5f));
}

struct WeightRow
{
    uint8_t* __restrict near;
    uint8_t* __restrict acrossX;
    uint8_t* __restrict acrossY;
    uint8_t* __restrict acrossBoth;
};

/// The cells whose pixels are weighed: count of them, from first on.
struct CellRange
{
    int first, count;
};

/// Weighs the cells around each pixel of a row. cells and across are the row of cells that the
/// pixels are in, and the next one; offsetY is the distance of the pixels from the middle of their
/// cells; even and odd are the columns of the pixels.
OSGRAYTRACE_KERNEL
void weighCells(SurfaceRow row, CellRange range, float offsetY, GuideRow cells, GuideRow across,
                WeightRow even, WeightRow odd)
{
    const float *nx = row.normalX, *ny = row.normalY, *nz = row.normalZ, *distance = row.distance;
    const int firstCell = range.first, count = range.count;
    const float far = offsetY > 0.0f ? offsetY - 1.0f : offsetY + 1.0f;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const int c = firstCell + i;
        const PixelSurface a{nx[2 * i], ny[2 * i], nz[2 * i], distance[2 * i]};
        const PixelSurface b{nx[2 * i + 1], ny[2 * i + 1], nz[2 * i + 1], distance[2 * i + 1]};
        even.near[i] = likeness(a, cells, c, -0.25f, offsetY, 9.0f); // 28 * 9 fits into a byte
        even.acrossX[i] = likeness(a, cells, c - 1, 0.75f, offsetY, 3.0f);
        even.acrossY[i] = likeness(a, across, c, -0.25f, far, 3.0f);
        even.acrossBoth[i] = likeness(a, across, c - 1, 0.75f, far, 1.0f);
        odd.near[i] = likeness(b, cells, c, 0.25f, offsetY, 9.0f);
        odd.acrossX[i] = likeness(b, cells, c + 1, -0.75f, offsetY, 3.0f);
        odd.acrossY[i] = likeness(b, across, c, 0.25f, far, 3.0f);
        odd.acrossBoth[i] = likeness(b, across, c + 1, -0.75f, far, 1.0f);
    }
}

/// Makes the guides of one row after the other, of pixels or of cells.
struct GuideMaker
{
    DenoiseGuides& guides;
    const std::vector<SurfaceSample>& surfaces;

    const SurfaceSample* samplesAt(int x, int y) const
    {
        return &surfaces[static_cast<std::size_t>(y) * static_cast<std::size_t>(guides.width) +
                         static_cast<std::size_t>(x)];
    }

    /// Unpacks a segment of row y, from column x on. Returns the number of pixels that it has.
    int unpackAt(Surfaces& s, int row, int x, int y) const
    {
        const int count = y < guides.height ? std::min(kSegment, guides.width - x) : 0;
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
        for (int x = 0; x < guides.width; x += kSegment)
        {
            for (int i = 0; i < 2; ++i)
            {
                const int y = 2 * row + i, count = unpackAt(s, i, x, y);
                if (count)
                    unpackAlbedo(samplesAt(x, y), s.distance[i], count, guides.albedoR.row(y) + x,
                                 guides.albedoG.row(y) + x, guides.albedoB.row(y) + x);
            }
            const int c = x / 2;
            makeCells(s, std::min(kSegment / 2, guides.cellsX - c),
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
        for (int x = 0; x < guides.width; x += kSegment)
        {
            unpackAt(s, 0, x, y);
            const int c = x / 2;
            const auto weights = [&](int first)
            {
                return WeightRow{guides.near.row(y) + first, guides.acrossX.row(y) + first,
                                 guides.acrossY.row(y) + first, guides.acrossBoth.row(y) + first};
            };
            weighCells(rowOf(s, 0), {c, std::min(kSegment / 2, guides.cellsX - c)},
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
    width = height = 0; // if memory runs out below
    cellsX = (pixelsX + 1) / 2;
    cellsY = (pixelsY + 1) / 2;
    for (PixelPlane<float>* plane : {&albedoR, &albedoG, &albedoB})
        plane->allocate(pixelsX, pixelsY);
    // Rows of whole cells.
    for (PixelPlane<uint8_t>* plane : {&inCell, &near, &acrossX, &acrossY, &acrossBoth})
        plane->allocate(2 * cellsX, 2 * cellsY);
    // A margin of pixels of which nothing is known and that hide nothing.
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
