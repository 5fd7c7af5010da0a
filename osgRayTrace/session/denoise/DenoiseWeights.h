// DenoiseWeights.h - how much light a pixel takes from the cells around it. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/denoise/DenoiseSurfaces.h"

#include <cstdint>

namespace osgRayTrace::engine
{

/// Points to a row of cells, as the pixels beside it read it.
struct GuideRow
{
    const float *normalX, *normalY, *normalZ, *distance, *slopeX, *slopeY, *sharpness;
};

/// Points to the weights of the pixels of even or of odd columns in a row, see DenoiseGuides.
struct WeightRow
{
    uint8_t* __restrict near;
    uint8_t* __restrict acrossX;
    uint8_t* __restrict acrossY;
    uint8_t* __restrict acrossBoth;
};

/// Names the cells whose pixels are weighed: count cells, from first on.
struct CellRange
{
    int first, count;
};

/// Weighs the cells around each pixel of a row. cells and across are the row of cells that the
/// pixels are in, and the next one. offsetY is the distance of the pixels from the middle of their
/// cells. even and odd are the columns of the pixels.
void weighCells(SurfaceRow row, CellRange range, float offsetY, GuideRow cells, GuideRow across,
                WeightRow even, WeightRow odd);

} // namespace osgRayTrace::engine
