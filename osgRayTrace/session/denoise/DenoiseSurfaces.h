// DenoiseSurfaces.h - surfaces of pixels and cells as columns. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/session/denoise/DenoisePlanes.h"
#include "osgRayTrace/session/image/ResolvedImage.h"

namespace osgRayTrace::engine
{

constexpr float kNoSurface = 1e30f; ///< a distance that differs from all others

constexpr int kSurfaceSegment =
    256; ///< pixels of two rows that are worked on while they are in the cache

/// How far distances on one surface may be from those on a plane: this much of the distance.
constexpr float kDistanceTolerance = 0.01f;

/// One array for each quantity, for pixels of two rows.
struct Surfaces
{
    float normalX[2][kSurfaceSegment], normalY[2][kSurfaceSegment], normalZ[2][kSurfaceSegment];
    float distance[2][kSurfaceSegment];
};

/// The surfaces of a row of pixels or of cells.
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

/// Three rows of findScattering. The pixels before the first and past the last are looked at.
struct ScatterRows
{
    const uint8_t *below, *here, *above;
};

/// 1 for pixels whose surface scatters the light that is seen there, and is finite.
void findScattering(const SurfaceSample* samples, int count, uint8_t* __restrict scatters);

/// Unpacks the surfaces of one row. Pixels past its end have no surface. A pixel beside one that
/// does not scatter has none either: it may show some of a lamp or of the sky.
void unpack(const SurfaceSample* samples, ScatterRows scatters, int count, SurfaceRow row);

void unpackAlbedo(const SurfaceSample* samples, const float* distance, int count,
                  float* __restrict r, float* __restrict g, float* __restrict b);

/// The means over those pixels that show the same as the first that shows anything.
void makeCells(const Surfaces& s, int count, SurfaceRow cells, uint8_t* __restrict inCell0,
               uint8_t* __restrict inCell1);

/// How alike surfaces are in their normals, as fallOff's argument [Schied17, eq. 4]: about cos^128.
OSGRAYTRACE_INLINE float normalDistance(float ax, float ay, float az, float bx, float by, float bz)
{
    const float cosine = ax * bx + ay * by + az * bz;
    return 128.0f * (1.0f - cosine);
}

} // namespace osgRayTrace::engine
