// TileSamples.h - further samples of single pixels of a tile. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/TileLayout.h"

#include <cstdint>

namespace osgRayTrace::engine
{

/// Holds the samples that the pixels of a tile get beside those of the film. Pixel p of the tile is
/// lane p % kLanes of block p / kLanes.
struct TileSamples
{
    int tile = 0;
    uint8_t wanted[kTilePixels] = {}; ///< samples that are wanted of each pixel
    uint8_t count[kTilePixels] = {};  ///< samples that were made: those wanted, or fewer
    TileRgba mean = {};               ///< linear radiance and coverage, of count samples
};

} // namespace osgRayTrace::engine
