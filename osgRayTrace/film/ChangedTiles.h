// ChangedTiles.h - the parts of a picture that were written since it was copied. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds a mark for each tile of a picture, tiles in rows as Film numbers them. Different threads
/// may mark different tiles.
struct ChangedTiles
{
    /// Clears all marks, for a picture of so many pixels.
    void reset(int width, int height);
    void add(const ChangedTiles& others); ///< others: of the same size

    int width = 0, height = 0;  ///< [pixels]
    std::vector<uint8_t> color; ///< tiles whose display values were written
    std::vector<uint8_t> depth;
};

struct PixelRect
{
    int x = 0, y = 0, width = 0, height = 0;
};

/// Returns rectangles that hold all marked tiles, none twice and nothing else; or one rectangle of
/// the whole picture, if that takes less time. The list is empty without marks. marks: color or
/// depth of a picture of so many pixels.
std::vector<PixelRect> changedRects(const std::vector<uint8_t>& marks, int width, int height);

} // namespace osgRayTrace::engine
