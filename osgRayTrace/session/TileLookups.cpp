// TileLookups.cpp - takes discs that were wrong out of the image again. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/TileLookups.h"

#include <algorithm>
#include <cstdlib>

namespace osgRayTrace::engine
{

namespace
{

/// What is left of a disc's light in the end is 0 but for rounding, and never less.
constexpr float kRoundedDown = 1.0f - 0x1p-19f;

/// Returns how many of the first passes belong to a half.
int passesOfHalf(int passes, int half)
{
    return (passes + 1 - half) / 2;
}

} // namespace

void TileLookups::forgetDiscs(int pass, const GatheredPhotons& gathered, RgbaLanes* rgba)
{
    const int half = pass & 1;
    for (std::size_t p = 0; p < kTilePixels; ++p)
    {
        const bool isFootprint = planes[p].lookup == PixelLookup::Footprint;
        if (changes[p] == 0 && pass < kChoosingPasses)
        {
            discs[half][p] += gathered.atFirstHits[p];
            if (isFootprint) changes[p] = static_cast<uint8_t>(pass + 1);
            continue;
        }
        if (changes[p] == 0 || !isFootprint || pass < changes[p]) continue;
        const int wrong = passesOfHalf(changes[p], half);
        if (pass / 2 >= wrong * (1 + kRepayingPasses)) continue;
        const Vec3 added =
            (gathered.atFirstHits[p] - discs[half][p] * (kRoundedDown / float(wrong))) *
            (1.0f / kRepayingPasses);
        RgbaLanes& block = rgba[p / kLanes];
        block.r[p % kLanes] += added.x;
        block.g[p % kLanes] += added.y;
        block.b[p % kLanes] += added.z;
    }
}

void TileLookups::endChoosing()
{
    static const int par = atoi(getenv("SK_PAR") ? getenv("SK_PAR") : "3");
    bool changed[kTileSize + 2][kTileSize + 2] = {};
    for (int p = 0; p < kTilePixels; ++p)
        changed[laneY(p / kLanes, p % kLanes) + 1][laneX(p / kLanes, p % kLanes) + 1] =
            planes[p].lookup == PixelLookup::Footprint;
    int count = 0;
    for (int p = 0; p < kTilePixels; ++p)
    {
        if (planes[p].lookup == PixelLookup::Compared)
        {
            const int x = laneX(p / kLanes, p % kLanes), y = laneY(p / kLanes, p % kLanes);
            int neighbours = 0;
            for (int row = y; row <= y + 2; ++row)
                for (int column = x; column <= x + 2; ++column)
                    neighbours += changed[row][column];
            if (neighbours >= par)
            {
                planes[p].lookup = PixelLookup::Footprint;
                changes[p] = kChoosingPasses;
            }
        }
        count += planes[p].lookup == PixelLookup::Footprint;
        if (planes[p].lookup == PixelLookup::Compared)
            discLight += luminance(discs[0][p] + discs[1][p]);
    }
    leaks = count >= kTilePixels / 16 && discLight > 0.0f;
    static const bool off = getenv("SK_NOLEAK");
    if (off) leaks = false;
}

void TileLookups::takeLeaked(int pass, Vec3 leaked, RgbaLanes* rgba) const
{
    static const float kappa = atof(getenv("SK_KAPPA") ? getenv("SK_KAPPA") : "1.33");
    const float share = (mayForgetDiscs(pass) ? 1.0f + kappa / kRepayingPasses : 1.0f) / discLight;
    for (std::size_t p = 0; p < kTilePixels; ++p)
    {
        if (planes[p].lookup != PixelLookup::Compared) continue;
        const Vec3 taken = leaked * (luminance(discs[0][p] + discs[1][p]) * share);
        RgbaLanes& block = rgba[p / kLanes];
        block.r[p % kLanes] -= taken.x;
        block.g[p % kLanes] -= taken.y;
        block.b[p % kLanes] -= taken.z;
    }
}

double TileLookups::discShare(std::size_t pixel, int passes) const
{
    double left = 0.0;
    for (int half = 0; half < 2; ++half)
    {
        const int wrong = passesOfHalf(std::min(int(changes[pixel]), passes), half);
        const int repaid = passesOfHalf(passes, half) - wrong;
        left += std::max(0.0, wrong - double(repaid) / kRepayingPasses);
    }
    return left / passes;
}

} // namespace osgRayTrace::engine
