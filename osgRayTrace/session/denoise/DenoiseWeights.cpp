// DenoiseWeights.cpp - compares pixels with cells. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseWeights.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Holds the surface of a pixel.
struct PixelSurface
{
    float normalX, normalY, normalZ, distance;
};

/// Returns the weight of a cell for a pixel, as a number of 28 * most at most. c: index of a cell
/// at most one off the picture; cells off the picture have no surface. offsetX, offsetY: place of
/// the pixel from the middle of the cell, in cells.
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

} // namespace

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

} // namespace osgRayTrace::engine
