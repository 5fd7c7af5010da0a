// PathFlags.h - the word with the pixel and the history of a path. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/film/Film.h"

namespace osgRayTrace::engine
{

/// PathFlags names a pixel of the tile and facts about a path. The facts are bits of one word
/// because vector code writes the words of sixteen paths at once; all other code reads facts by
/// name.
class PathFlags
{
public:
    PathFlags() = default;
    explicit PathFlags(uint32_t word) : _word(word) {}

    /// Returns the flags of a camera ray. pixel is block * kLanes + lane, below kTilePixels.
    static PathFlags ofPixel(uint32_t pixel)
    {
        OSGRAYTRACE_ASSERT(pixel < kTilePixels);
        return PathFlags(pixel);
    }

    uint32_t word() const { return _word; }

    /// Returns the pixel of the tile, below kTilePixels.
    uint32_t pixel() const { return _word & (kTilePixels - 1); }

    /// Returns the index in PixelSums at which the path's light is added. Reused paths have sums of
    /// their own.
    uint32_t sum() const { return _word & (kReused | (kTilePixels - 1)); }

    /// Returns whether the path has met its second surface and gives the light that it finds from
    /// there on to other pixels, too. A reused path has taken photons if photons are used, and so
    /// looks up no more photons: the radii of look-ups belong to pixels, not to sums.
    bool isReused() const { return (_word & kReused) != 0; }

    /// Returns whether the path has left a surface that is not a mirror. Such a path does not see
    /// the background, which is a backdrop and not a light, and it sees the environment as a light,
    /// not interpolated.
    bool isScattered() const { return (_word & kScattered) != 0; }

    /// Returns whether the path has looked up photons on a rough surface. The fact matters with
    /// PhotonUse::Caustics.
    bool hasTaken() const { return (_word & kTaken) != 0; }

    /// Returns whether photons already carry the light that the path meets now. Either a glossy
    /// surface after the look-up has scattered the path, or the path has met mirror-like surfaces
    /// since the last surface that scattered it. That surface is then one that photons know: the
    /// rough surface of the look-up, any surface after it, a glossy surface where direct photons
    /// were looked up, or a medium where they were. With PhotonUse::Indirect that is a medium
    /// alone.
    bool isOnCausticChain() const { return (_word & kCausticChain) != 0; }

    /// Returns whether the path is one of the two into which a camera path has split.
    bool isSplit() const { return (_word & kSplit) != 0; }

    /// Returns the flags of the same path, marked as one of two.
    PathFlags split() const { return PathFlags(_word | kSplit); }

    /// Returns the flags of the same path, marked as reused.
    PathFlags reused() const { return PathFlags(_word | kReused); }

    /// Returns whether the path has last been scattered by a medium, or met mirror-like surfaces
    /// alone since then. A ray that comes straight from the medium does not count lights that are
    /// sampled.
    bool hasCollided() const { return (_word & kCollided) != 0; }

    /// Returns the sides of panes, a bit for each, whose mirrored sky the surface that scattered
    /// the path last has sampled; 0 once a mirror-like surface has followed. See
    /// PathPaneMirrors.cpp.
    uint32_t paneSides() const { return (_word & kPaneSides) / kPaneSide; }

    /// Returns the flags of the same path after such a surface.
    PathFlags withPaneSides(uint32_t sides) const { return PathFlags(_word | sides * kPaneSide); }

    /// Returns whether a pane has mirrored the path since, so that samples have the sky's light.
    bool isMirroredSky() const { return (_word & kMirroredSky) != 0; }

    /// Returns the flags of the same path after such a pane.
    PathFlags mirroredSky() const { return PathFlags(_word | kMirroredSky); }

    /// Returns the flags of the same path after a medium has scattered it.
    PathFlags collided() const
    {
        return PathFlags((_word & ~(kCausticChain | kGathered)) | kScattered | kCollided);
    }

    /// Returns the flags of the same path after a medium has scattered it, where photons are looked
    /// up as on a rough surface.
    PathFlags collidedAmongPhotons() const
    {
        return PathFlags(collided().word() | kTaken | kGathered);
    }

    /// Returns the flags of the same path after a medium has scattered it, where photons are looked
    /// up that have met mirror-like surfaces alone: the path goes on as if nothing had been taken.
    PathFlags collidedAmongCaustics() const { return PathFlags(collided().word() | kGathered); }

    /// Returns the word after a surface, for loops over lanes. Each of the other arguments is all
    /// bits or none: gathering if photons were looked up, rough if photons were looked up on a
    /// rough surface, carried if photons carry what the surface scatters of the light that the path
    /// may meet next, mirrored if the path goes on by a mirror-like lobe.
    OSGRAYTRACE_INLINE static uint32_t afterSurface(uint32_t word, uint32_t gathering,
                                                    uint32_t rough, uint32_t carried,
                                                    uint32_t mirrored)
    {
        const uint32_t taken = (word | rough) & kTaken;
        const uint32_t gathered = (gathering & kGathered) | (taken / kTaken * kGathered);
        const uint32_t scattered =
            (word & ~(kCausticChain | kGathered | kCollided | kPaneSides | kMirroredSky)) |
            kScattered | taken | gathered | (carried & kCausticChain);
        const uint32_t chained = (word & ~(kPaneSides | kMirroredSky)) |
                                 ((0u - ((word / kGathered) & 1u)) & kCausticChain);
        return (chained & mirrored) | (scattered & ~mirrored);
    }

private:
    static constexpr uint32_t kReused = kTilePixels; // the bit above the pixel: sum() is an index
    static constexpr uint32_t kScattered = 0x10000u;
    static constexpr uint32_t kCausticChain = 0x20000u;
    /// The last surface that scattered the path is one that photons know.
    static constexpr uint32_t kGathered = 0x40000u;
    static constexpr uint32_t kTaken = 0x80000u;
    static constexpr uint32_t kSplit = 0x100000u;
    static constexpr uint32_t kCollided = 0x200000u;
    static constexpr uint32_t kPaneSide = 0x400000u; ///< the least bit of four
    static constexpr uint32_t kPaneSides = 15u * kPaneSide;
    static constexpr uint32_t kMirroredSky = 0x4000000u;
    static_assert((kTilePixels & (kTilePixels - 1)) == 0 && 2 * kTilePixels <= kScattered,
                  "the pixel and the bit of reuse are below the other bits");

    uint32_t _word = 0;
};

} // namespace osgRayTrace::engine
