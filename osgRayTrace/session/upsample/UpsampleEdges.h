// UpsampleEdges.h - blocks of pixels at edges: traces first hits, takes radiance from pixels alike.
// Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/session/upsample/UpsampleSource.h"

namespace osgRayTrace::engine
{

/// Holds a block of the full size, with lanes as in laneX and laneY.
struct UpsampledBlock
{
    RgbaLanes rgba;
    alignas(64) float depth[kLanes];
    LaneMask unlike; ///< none of the four pixels around sees the lanes' surface
};

/// Traces a block whose first pixel, (left, bottom), is inside of the image. Lanes outside of the
/// image repeat its last pixels. For last see surfacesOf.
void traceUpsampled(const UpsampleSource& source, int left, int bottom, LastTriangle& last,
                    UpsampledBlock& block);

} // namespace osgRayTrace::engine
