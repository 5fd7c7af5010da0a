// DenoiseTaps.h - the cells around a cell, as the loops of the denoiser read them. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/session/denoise/DenoiseCells.h"

#include <cmath>

namespace osgRayTrace::engine
{

struct GuideTap
{
    const float *normalX, *normalY, *normalZ, *distance;
};

struct LightTap
{
    const float *r, *g, *b, *variance;
};

inline GuideTap guideTap(const DenoiseGuides& guides, int y)
{
    const CellGuides& cells = guides.cells;
    return {cells.normalX.row(y), cells.normalY.row(y), cells.normalZ.row(y),
            cells.distance.row(y)};
}

inline LightTap lightTap(const CellLight& light, int y)
{
    return {light.r.row(y), light.g.row(y), light.b.row(y), light.variance.row(y)};
}

/// Holds the surface in the middle of the taps.
struct Centre
{
    float normalX, normalY, normalZ, distance, slopeX, slopeY, sharpness;
};

/// Returns how much the surface at a tap differs from that in the middle, as fallOff's argument
/// [Schied17, eq. 3, 4]. Depth is compared with the plane through the middle's surface. dx, dy:
/// offset of the tap in cells.
OSGRAYTRACE_INLINE float surfaceDistance(const Centre& centre, const GuideTap& tap, int i, float dx,
                                         float dy)
{
    const float plane = centre.distance + dx * centre.slopeX + dy * centre.slopeY;
    return std::fabs(tap.distance[i] - plane) * centre.sharpness +
           normalDistance(centre.normalX, centre.normalY, centre.normalZ, tap.normalX[i],
                          tap.normalY[i], tap.normalZ[i]);
}

/// Points to the slopes of the planes through the cells of a row.
struct PlaneRow
{
    const float *slopeX, *slopeY, *sharpness;
};

struct OutRow
{
    float* __restrict r;
    float* __restrict g;
    float* __restrict b;
    float* __restrict variance;
};

} // namespace osgRayTrace::engine
