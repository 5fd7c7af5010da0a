// PathFlags.h - the word that each path carries: its pixel, and what has happened to it. Layer:
// integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/film/Film.h"

namespace osgRayTrace::engine
{

/// A pixel of the tile and four facts about a path. The facts are bits of one word because vector
/// code writes them for sixteen paths at once; all other code reads them by name.
class PathFlags
{
public:
    PathFlags() = default;
    explicit PathFlags(uint32_t word) : _word(word) {}

    /// A camera ray of a pixel of the tile: block * kLanes + lane.
    static PathFlags ofPixel(uint32_t pixel)
    {
        OSGRAYTRACE_ASSERT(pixel < kTilePixels);
        return PathFlags(pixel);
    }

    uint32_t word() const { return _word; }

    /// The pixel of the tile, below kTilePixels.
    uint32_t pixel() const { return _word & (kTilePixels - 1); }

    /// Where the path's light is added up, see PixelSums: light of reused paths is kept apart.
    uint32_t sum() const { return _word & (kReused | (kTilePixels - 1)); }

    /// The path has met its second surface, and other pixels get the light that it finds from there
    /// on, too. A reused path has taken photons if photons are used, and so looks up no more of
    /// them: the radii of lookups belong to pixels, not to sums.
    bool isReused() const { return (_word & kReused) != 0; }

    /// The path has left a surface that is not a mirror. From then on it does not see the
    /// background, which is a backdrop and not a light, and it sees the environment as the light
    /// that it is, not interpolated.
    bool isScattered() const { return (_word & kScattered) != 0; }

    /// Photons were looked up on a rough surface. PhotonUse::Caustics.
    bool hasTaken() const { return (_word & kTaken) != 0; }

    /// The last surface that scattered the path is one that photons know (the rough one where they
    /// were looked up, any after it, or a glossy one where the direct ones were looked up), and the
    /// path has met mirror-like surfaces since: the light that it meets now is that of photons.
    /// PhotonUse::Caustics.
    bool isOnCausticChain() const { return (_word & kCausticChain) != 0; }

    PathFlags reused() const { return PathFlags(_word | kReused); }

    /// The word after a surface, for loops over lanes. Each other argument is all bits or none:
    /// photons were looked up, on a rough surface, and the path goes on by a mirror-like lobe.
    OSGRAYTRACE_INLINE static uint32_t afterSurface(uint32_t word, uint32_t gathering,
                                                    uint32_t rough, uint32_t mirrored)
    {
        const uint32_t taken = (word | rough) & kTaken;
        const uint32_t gathered = (gathering & kGathered) | (taken / kTaken * kGathered);
        const uint32_t scattered =
            (word & ~(kCausticChain | kGathered)) | kScattered | taken | gathered;
        const uint32_t chained = word | ((0u - ((word / kGathered) & 1u)) & kCausticChain);
        return (chained & mirrored) | (scattered & ~mirrored);
    }

private:
    static constexpr uint32_t kReused = kTilePixels; // sum() is an index
    static constexpr uint32_t kScattered = 0x10000u;
    static constexpr uint32_t kCausticChain = 0x20000u;
    /// The last surface that scattered the path is one that photons know.
    static constexpr uint32_t kGathered = 0x40000u;
    static constexpr uint32_t kTaken = 0x80000u;
    static_assert((kTilePixels & (kTilePixels - 1)) == 0 && 2 * kTilePixels <= kScattered,
                  "the pixel and the bit of reuse are below the other bits");

    uint32_t _word = 0;
};

} // namespace osgRayTrace::engine
