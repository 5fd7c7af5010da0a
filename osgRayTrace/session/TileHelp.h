// TileHelp.h - tiles of a pass that are traced elsewhere. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/RenderOptions.h"
#include "osgRayTrace/integrators/shared/SurfaceSample.h"
#include "osgRayTrace/integrators/shared/TileResult.h"
#include "osgRayTrace/photons/PhotonUse.h"
#include "osgRayTrace/scene/View.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

class TracedScene;
struct PhotonPass; // photons: the map of a pass

/// The photons of a pass.
struct HelpedPhotons
{
    PhotonUse use = PhotonUse::None;
    std::shared_ptr<const PhotonPass> pass; ///< null if use is None
    float cellSize = 0.0f;                  ///< of its map
    float leastRadius = 0.0f, largestRadius = 0.0f;
};

/// All that the tiles of a pass depend on, but for TilePhotons: whoever traces them from these
/// values gets the same bits.
struct HelpedPass
{
    std::shared_ptr<const TracedScene> scene;
    View view;
    RenderOptions options; ///< its seed is that of the image's sequence
    int pass = 0;
    bool centred = false;       ///< whether camera rays look through the middles of pixels
    bool wantsDepth = false;    ///< whether the image gets its depths from this pass
    bool wantsSurfaces = false; ///< with wantsDepth: whether TracedTile::surfaces are wanted
    bool wantsSamples = false;  ///< with wantsDepth: whether TracedTile::samples are wanted
    HelpedPhotons photons;
};

/// What look-ups of photons read and write of a tile: see GatheredPhotons, whose planes are here.
struct TilePhotons
{
    GatheredPhotons gathered;
    std::vector<SeenPlane> planes; ///< kTilePixels, or empty: all look-ups are discs
};

/// A tile of such a pass.
struct TracedTile
{
    TracedTile() {} // the arrays are written before they are read

    TileRgba rgba;
    TileCounts counts;
    float depth[kTilePixels];             ///< with wantsDepth
    SurfaceBlock surfaces[kTileBlocks];   ///< with wantsSurfaces
    std::vector<SurfaceSample> samples;   ///< with wantsSamples: kTilePixels of them
    std::unique_ptr<TilePhotons> photons; ///< null unless the pass has photons
};

/// What a session lets its helpers do with the tiles of a pass. Any thread that traces for the pass
/// calls, while PassHelp::exchange() runs.
struct SharedTiles
{
    /// Returns a tile that nobody traces yet, and gives it away; negative: there is none left.
    std::function<int()> take;
    /// Takes a tile that was given away. Different threads may bring different tiles.
    std::function<void(int tile, const TracedTile& traced)> bring;
    std::function<int()> left; ///< returns about how many tiles nobody traces yet
    /// Returns what look-ups of photons in a tile begin with, for passes that have photons.
    std::function<TilePhotons(int tile)> photonsOf;
};

/// Helpers at work on a pass. Those that are late when this goes are not waited for.
class PassHelp
{
public:
    virtual ~PassHelp() = default;

    /// Gives tiles away to whoever has time for them, and takes those that have come. Any thread
    /// that traces for the pass calls this between its tiles; it never waits.
    virtual void exchange() = 0;

    /// Returns how many tiles are given away and have not come back.
    virtual int awaited() const = 0;

    /// Returns tiles that should have come back by now: the caller traces them itself, and what a
    /// helper sends of them later is ignored.
    virtual std::vector<int> takeLate() = 0;
};

/// Those who help views with their passes. Thread safe: views may be traced at once.
class TileHelp
{
public:
    virtual ~TileHelp() = default;

    /// Begins to help with a pass; null if nobody is there. tiles lives longer than the result.
    virtual std::unique_ptr<PassHelp> begin(const HelpedPass& pass, const SharedTiles& tiles) = 0;

    /// Adds a sentence for the user, which is said once.
    virtual void note(const std::string& sentence) = 0;
};

} // namespace osgRayTrace::engine
