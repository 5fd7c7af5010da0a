// Film.h - the accumulated image: sums of two independent halves of the passes. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/base/LargeArray.h"
#include "osgRayTrace/film/ExactSums.h"
#include "osgRayTrace/film/TileLayout.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Tells how a film adds up passes.
enum class FilmSums : uint8_t
{
    Fast,  ///< float, with totals in double: for images that are shown
    Exact, ///< fixed point: the sums do not depend on the order of the passes
};

/// Holds the sums of two halves: even passes go to the first half, the others to the second. The
/// halves are sampled independently, so that for the mean m = (a + b)/2 of their means the variance
/// estimate (a - b)^2/4 is unbiased [Rousselle12, sect. 3]; see errorScale for halves of different
/// numbers of passes. Tiles are independent: different threads may write different tiles. Fast sums
/// of a bounded number of passes are float, their totals double.
class Film
{
public:
    /// Clears the image. Throws EngineError(OutOfMemory) past kMaxPixels or when memory runs out.
    void reset(int width, int height, FilmSums kind = FilmSums::Fast);

    static constexpr int64_t kMaxPixels = int64_t(1) << 28;

    int width() const { return _width; }
    int height() const { return _height; }
    int tileCount() const { return _tilesX * _tilesY; }
    int tileX(int tile) const { return tile % _tilesX * kTileSize; } ///< left pixel column
    int tileY(int tile) const { return tile / _tilesX * kTileSize; } ///< bottom pixel row

    /// Returns the complete passes of a tile; tiles differ after a cancelled pass.
    int tilePasses(int tile) const { return halfPasses(tile, 0) + halfPasses(tile, 1); }
    /// Returns the number of passes that every tile has.
    int passes() const;

    /// Returns how the passes are added up.
    FilmSums sumsKind() const { return _exact.empty() ? FilmSums::Fast : FilmSums::Exact; }

    /// Prepares a pass; called before the tiles of the pass, by one thread.
    void beginPass();

    /// Returns kTileBlocks blocks into which a pass of a tile can be written without a copy;
    /// finishPass then completes the pass. Null if addPass has to be called, as for all passes but
    /// the first of each half, and for exact sums.
    RgbaLanes* firstPassStorage(int tile, int pass);
    void finishPass(int tile, int pass);

    /// Says that the window depths of the image before reset() hold on in tiles without a pass.
    void holdDepths() { _holdsDepths = true; }

    /// Returns whether the tile has window depths.
    bool hasDepth(int tile) const { return _holdsDepths || tilePasses(tile) > 0; }

    /// Adds a pass of a tile: the number of the pass tells the half. Returns how many values exact
    /// sums cannot hold and leave out: those that are not finite, or from 2^40 on.
    int addPass(int tile, int pass, const RgbaLanes* values);

    /// Returns the sums of an exact film.
    const ExactSums& exactSums() const { return _exact; }

    /// Replaces a half of a tile of an exact film. sums: ExactSums::kValues of them.
    void setHalf(int tile, int half, int passes, const ExactSum* sums);

    /// Returns the window depth of the tile's pixels, lanes of block b at b*kLanes, which is
    /// written with the tile's first pass.
    float* depth(int tile) { return &_depth[static_cast<std::size_t>(tile) * kTilePixels]; }
    const float* depth(int tile) const
    {
        return &_depth[static_cast<std::size_t>(tile) * kTilePixels];
    }

    /// Returns the mean radiance of a tile's passes; transparent black before the first.
    void mean(int tile, TileRgba& values) const;

    /// Returns the means of the two halves; needs a pass of each.
    void halfMeans(int tile, TileRgba& first, TileRgba& second) const;

    /// Returns the factor of |a - b| that makes it the standard error of the mean of all passes,
    /// with a and b the halves' means. The factor is 1/2, and about 1/2 for an odd number of
    /// passes, because the halves then differ in size; it is 0 if a half has no pass.
    float errorScale(int tile) const;

    /// Returns the passes of a half of a tile.
    int halfPasses(int tile, int half) const
    {
        OSGRAYTRACE_ASSERT(tile >= 0 && tile < tileCount());
        return _passes[static_cast<std::size_t>(tile) * 2 + static_cast<std::size_t>(half)];
    }

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
    ExactSums _exact;                ///< in place of _sums and _totals; empty if these are used
    std::vector<int> _passes;        ///< tile, half
    bool _holdsDepths = false;
};

} // namespace osgRayTrace::engine
