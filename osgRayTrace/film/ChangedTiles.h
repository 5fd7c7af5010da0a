// ChangedTiles.h - the parts of a picture that were written since it was copied. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// A mark for each tile of a picture, tiles in rows as Film numbers them. Different threads may
/// mark different tiles.
struct ChangedTiles
{
    /// None are, of a picture of so many pixels.
    void reset(int width, int height);
    void add(const ChangedTiles& others); ///< of the same size

    int width = 0, height = 0;  ///< [pixels]
    std::vector<uint8_t> color; ///< display values
    std::vector<uint8_t> depth;
};

struct PixelRect
{
    int x = 0, y = 0, width = 0, height = 0;
};

/// Rectangles that hold all marked tiles, none twice and nothing else; or one of the whole picture,
/// if that takes less time. Empty without marks. marks: color or depth of a picture of so many
/// pixels.
std::vector<PixelRect> changedRects(const std::vector<uint8_t>& marks, int width, int height);

} // namespace osgRayTrace::engine
