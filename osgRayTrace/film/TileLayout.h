// TileLayout.h - tiles of an image, and blocks of lanes in them. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"

namespace osgRayTrace::engine
{

constexpr int kTileSize = 16; ///< [pixels] along a side
constexpr int kTilePixels = kTileSize * kTileSize;
constexpr int kBlockSize = 4; ///< a block of lanes is 4 x 4 pixels
constexpr int kTileBlocks = kTilePixels / kLanes;

/// Returns the number of tiles along an image's side.
inline int tilesAlong(int pixels)
{
    return (pixels + kTileSize - 1) / kTileSize;
}

/// Returns the position of a lane of a block within its tile, in pixels.
OSGRAYTRACE_INLINE int laneX(int block, int lane)
{
    return (block & 3) * kBlockSize + (lane & 3);
}
OSGRAYTRACE_INLINE int laneY(int block, int lane)
{
    return (block >> 2) * kBlockSize + (lane >> 2);
}

/// Holds RGBA of the pixels of a block.
struct RgbaLanes
{
    FloatLanes r, g, b, a;
};

/// Holds the radiance of one pass for a tile, block by block.
using TileRgba = RgbaLanes[kTileBlocks];

} // namespace osgRayTrace::engine
