// Film.h - the accumulated image: sums of two independent halves of the passes. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/LargeArray.h"
#include "osgRayTrace/base/Math.h"

#include <cstdint>
#include <vector>

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

/// Holds the sums of two halves: passes 0, 2, 4, ... go to the first half, the others to the
/// second. The halves are sampled independently, so that for the mean m = (a + b)/2 of their means
/// the variance estimate (a - b)^2/4 is unbiased [Rousselle12, sect. 3]; see errorScale for an odd
/// number of passes. Tiles are independent: different threads may write different tiles. Sums of
/// a bounded number of passes are float, their totals double.
class Film
{
public:
    /// Clears the image. Throws EngineError(OutOfMemory) past kMaxPixels or when memory runs out.
    void reset(int width, int height);

    static constexpr int64_t kMaxPixels = int64_t(1) << 28;

    int width() const { return _width; }
    int height() const { return _height; }
    int tileCount() const { return _tilesX * _tilesY; }
    int tileX(int tile) const { return tile % _tilesX * kTileSize; } ///< left pixel column
    int tileY(int tile) const { return tile / _tilesX * kTileSize; } ///< bottom pixel row

    /// Returns the complete passes of a tile; tiles differ after a cancelled pass.
    int tilePasses(int tile) const
    {
        OSGRAYTRACE_ASSERT(tile >= 0 && tile < tileCount());
        return _passes[static_cast<std::size_t>(tile)];
    }
    /// Returns the number of passes that every tile has.
    int passes() const;

    /// Prepares a pass; called before the tiles of the pass, by one thread.
    void beginPass();

    /// Returns kTileBlocks blocks into which the next pass of a tile can be written without a copy.
    /// finishPass completes the pass. Null if the tile's half has passes already: the caller then
    /// needs addPass.
    RgbaLanes* firstPassStorage(int tile);
    void finishPass(int tile);

    /// Says that the window depths of the image before reset() hold on in tiles without a pass.
    void holdDepths() { _holdsDepths = true; }

    /// Returns whether the tile has window depths.
    bool hasDepth(int tile) const { return _holdsDepths || tilePasses(tile) > 0; }

    /// Adds the next pass of a tile.
    void addPass(int tile, const RgbaLanes* values);

    /// Returns the window depth of the tile's pixels, lanes of block b at b*kLanes, which is
    /// written with the tile's first pass.
    float* depth(int tile) { return &_depth[static_cast<std::size_t>(tile) * kTilePixels]; }
    const float* depth(int tile) const
    {
        return &_depth[static_cast<std::size_t>(tile) * kTilePixels];
    }

    /// Returns the mean radiance of a tile's passes; transparent black before the first.
    void mean(int tile, TileRgba& values) const;

    /// Returns the means of the two halves; needs two passes.
    void halfMeans(int tile, TileRgba& first, TileRgba& second) const;

    /// Returns the factor of |a - b| that makes it the standard error of the mean of all passes,
    /// with a and b the halves' means. The factor is 1/2, and about 1/2 for an odd number of
    /// passes, because the halves then differ in size; it is 0 below two passes.
    float errorScale(int tile) const;

private:
    static constexpr int kFoldPasses = 128; ///< passes of a half that are summed in float

    float* sums(int tile, int half);
    const float* sums(int tile, int half) const;
    void halfMean(int tile, int half, TileRgba& values) const;
    void fold(int tile, int half);

    int _width = 0;
    int _height = 0;
    int _tilesX = 0;
    int _tilesY = 0;
    UnclearedArray<RgbaLanes> _sums; ///< tile, half, block
    std::vector<double> _totals;     ///< tile, half, block; empty until a half has kFoldPasses
    UnclearedArray<float> _depth;    ///< tile, block, lane
    std::vector<int> _passes;        ///< passes of a tile
    bool _holdsDepths = false;
};

} // namespace osgRayTrace::engine
