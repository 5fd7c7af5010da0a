// FirstPasses.cpp - takes the first passes of an image back. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/FirstPasses.h"

namespace osgRayTrace::engine
{

void FirstPasses::reset(std::size_t tiles)
{
    std::vector<Tile>(tiles).swap(_tiles);
}

void FirstPasses::add(std::size_t number, int pass, const RgbaLanes* rgba)
{
    Tile& tile = _tiles[number];
    const auto bit = static_cast<uint8_t>(1u << pass);
    if (tile.passes & bit) return;
    tile.passes |= bit;
    for (int b = 0; b < kTileBlocks; ++b)
    {
        Vec3Lanes& sum = tile.sums[pass & 1][b];
        for (int i = 0; i < kLanes; ++i)
        {
            sum.x[i] += rgba[b].r[i];
            sum.y[i] += rgba[b].g[i];
            sum.z[i] += rgba[b].b[i];
        }
    }
}

int FirstPasses::replace(std::size_t number, int pass, RgbaLanes* rgba) const
{
    if (pass < kCount || pass >= 2 * kCount || !areComplete(number)) return 1;
    const Tile& tile = _tiles[number];
    for (int b = 0; b < kTileBlocks; ++b)
    {
        const Vec3Lanes& sum = tile.sums[pass & 1][b];
        for (int i = 0; i < kLanes; ++i)
        {
            rgba[b].r[i] = 2.0f * rgba[b].r[i] - 0.5f * sum.x[i];
            rgba[b].g[i] = 2.0f * rgba[b].g[i] - 0.5f * sum.y[i];
            rgba[b].b[i] = 2.0f * rgba[b].b[i] - 0.5f * sum.z[i];
        }
    }
    return 2;
}

} // namespace osgRayTrace::engine
