// UpsampleEdges.h - blocks of pixels at edges: first hits traced, radiance from pixels alike.
// Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/session/image/ResolvedImage.h"
#include "osgRayTrace/session/upsample/UpsampleCells.h"

namespace osgRayTrace::engine
{

/// What all blocks of an image work with.
struct UpsampleSource
{
    const ResolvedImage& image;
    const SurfaceSample* samples;
    const PassContext& full;
    UpsampleAxis x, y;
};

/// A block of the full size, lanes as laneX and laneY have them.
struct UpsampledBlock
{
    RgbaLanes rgba;
    alignas(64) float depth[kLanes];
    LaneMask unlike; ///< none of the four pixels around sees their surface
};

/// left, bottom: its first pixel, inside of the image. Lanes outside of it are of its last pixels.
void traceUpsampled(const UpsampleSource& source, int left, int bottom, UpsampledBlock& block);

} // namespace osgRayTrace::engine
