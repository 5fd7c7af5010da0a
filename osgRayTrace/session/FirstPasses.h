// FirstPasses.h - takes the first passes of an image back. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/film/TileLayout.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds the light of the first kCount passes of an image, for later passes that are so much better
/// that these only add noise. A film averages passes. So each of the kCount passes that follow
/// counts twice, and takes the mean of two of the first ones back, those of its own half of the
/// film: when all have done so, nothing of the first passes is left, and no half depends on the
/// other. The mean stays the same, as each pass has it. Tiles are independent: different threads
/// may add to and replace different ones.
class FirstPasses
{
public:
    static constexpr int kCount = 4;

    /// Makes room for tiles; 0: nothing is kept.
    void reset(std::size_t tiles);

    /// Returns whether nothing is kept: there is no room for tiles.
    bool empty() const { return _tiles.empty(); }
    /// Returns how much memory the tiles take [bytes].
    std::size_t bytes() const { return _tiles.size() * sizeof(Tile); }

    /// Adds the light of a tile in one of the first passes; of a pass that is made again only once.
    /// rgba: kTileBlocks blocks.
    void add(std::size_t tile, int pass, const RgbaLanes* rgba);

    /// Returns whether the tile has all of the first passes.
    bool areComplete(std::size_t tile) const
    {
        return !empty() && _tiles[tile].passes == (1u << kCount) - 1u;
    }

    /// Lets a pass replace one of the first. Returns how often the pass counts: twice if it is one
    /// from kCount to 2 kCount, the latter excluded, and the first ones are complete; else once.
    int replace(std::size_t tile, int pass, RgbaLanes* rgba) const;

private:
    struct Tile
    {
        Vec3Lanes sums[2][kTileBlocks]; ///< by half
        uint8_t passes = 0;             ///< bit p: pass p is in the sums
    };
    std::vector<Tile> _tiles;
};

} // namespace osgRayTrace::engine
