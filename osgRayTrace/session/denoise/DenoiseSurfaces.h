// DenoiseSurfaces.h - surfaces of pixels and cells as columns. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/session/denoise/DenoisePlanes.h"
#include "osgRayTrace/session/image/ResolvedImage.h"

namespace osgRayTrace::engine
{

constexpr float kNoSurface = 1e30f; ///< distance that differs from all others

/// Pixels of two rows that are worked on while they are in the cache.
constexpr int kSurfaceSegment = 256;

/// Largest difference of a distance from that of a plane, on one surface, as a share of the
/// distance.
constexpr float kDistanceTolerance = 0.01f;

/// Holds one array for each quantity, for pixels of two rows.
struct Surfaces
{
    float normalX[2][kSurfaceSegment], normalY[2][kSurfaceSegment], normalZ[2][kSurfaceSegment];
    float distance[2][kSurfaceSegment];
};

/// Points to the surfaces of a row of pixels or of cells.
struct SurfaceRow
{
    float* __restrict normalX;
    float* __restrict normalY;
    float* __restrict normalZ;
    float* __restrict distance;
};

inline SurfaceRow rowOf(Surfaces& s, int row)
{
    return {s.normalX[row], s.normalY[row], s.normalZ[row], s.distance[row]};
}

/// Points to three rows of findScattering's result, which are also read one pixel before the first
/// and one past the last.
struct ScatterRows
{
    const uint8_t *below, *here, *above;
};

/// Sets scatters to 1 for pixels whose surface scatters the light that they show, if that light is
/// finite, and otherwise to 0.
void findScattering(const SurfaceSample* samples, int count, uint8_t* __restrict scatters);

/// Unpacks the surfaces of one row. Pixels past the row's end get no surface. A pixel beside one
/// that does not scatter gets none either, as it may show some of a lamp or of the sky.
void unpack(const SurfaceSample* samples, ScatterRows scatters, int count, SurfaceRow row);

void unpackAlbedo(const SurfaceSample* samples, const float* distance, int count,
                  float* __restrict r, float* __restrict g, float* __restrict b);

/// Sets each cell to the mean over those of its pixels that show the same surface as the first of
/// them that shows any; inCell0 and inCell1 mark these pixels.
void makeCells(const Surfaces& s, int count, SurfaceRow cells, uint8_t* __restrict inCell0,
               uint8_t* __restrict inCell1);

/// Returns how much the normals of two surfaces differ, as fallOff's argument [Schied17, eq. 4]:
/// about cos^128.
OSGRAYTRACE_INLINE float normalDistance(float ax, float ay, float az, float bx, float by, float bz)
{
    const float cosine = ax * bx + ay * by + az * bz;
    return 128.0f * (1.0f - cosine);
}

} // namespace osgRayTrace::engine
