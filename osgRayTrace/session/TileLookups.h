// TileLookups.h - how the pixels of a tile have looked up photons so far. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/TileResult.h"

#include <cstdint>

namespace osgRayTrace::engine
{

/// Passes in which pixels may choose between discs and footprints: later ones cannot depend on how
/// many passes another machine has made.
constexpr int kChoosingPasses = 16;

/// What the pixels of a tile see, and the light of the discs that they have looked up. A pixel that
/// takes the photons of its footprint from some pass on has found its discs wrong, so their light
/// is taken out of the image again, and later passes count more in its place: see forgetDiscs. One
/// thread at a time.
struct TileLookups
{
    SeenPlane planes[kTilePixels];
    /// The light that photons have added at first hits in the even and the odd passes that looked
    /// up discs, or were to choose [radiance, summed over the passes].
    Vec3 discs[2][kTilePixels] = {};
    /// The number of the first pass that takes the photons of the footprint; 0: there is none yet.
    uint8_t changes[kTilePixels] = {};

    /// Tells whether discs leak light: see endChoosing.
    bool leaks = false;
    float discLight = 0.0f; ///< luminance of discs, over the pixels that compare

    /// Records a pass of the tile whose look-ups have come to an end, and corrects its light.
    ///
    /// A pixel that changes over at pass c has c_h passes of each half h of the film by discs,
    /// whose light is D_h. Each of the next kRepayingPasses c_h = n passes of that half, whose
    /// footprints have the light F, adds
    ///
    ///   F + (c_h F - D_h) / n
    ///
    /// in place of F. Weights of passes add up to their number at any time, and after these passes
    /// nothing of D_h is left. Each such pass depends on the first kChoosingPasses alone, and on
    /// none of the other half, so that passes may be made in any order and by several machines, and
    /// the halves stay independent.
    void forgetDiscs(int pass, const GatheredPhotons& gathered, RgbaLanes* rgba);

    /// Ends the choice of the tile's pixels, after pass kChoosingPasses - 1.
    void endChoosing();

    /// Takes the light that discs have too much out of the pixels that compare them.
    void takeLeaked(int pass, Vec3 leaked, RgbaLanes* rgba) const;

    /// Returns the share of the light of a pixel that is still that of discs from before it changed
    /// over, in the mean of so many passes from the first one on. The pixel has changed over.
    double discShare(std::size_t pixel, int passes) const;
};

/// The passes that make up for one by a disc. Fewer make the image right sooner, more have less
/// noise.
constexpr int kRepayingPasses = 2;

/// Returns whether some pixel may take part in forgetDiscs in this pass.
inline bool mayForgetDiscs(int pass)
{
    return pass < kChoosingPasses * (1 + kRepayingPasses);
}

} // namespace osgRayTrace::engine
