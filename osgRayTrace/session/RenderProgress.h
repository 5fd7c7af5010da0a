// RenderProgress.h - when a render stops, and how far the image has come. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Status.h"
#include "osgRayTrace/integrators/shared/RenderOptions.h"
#include "osgRayTrace/integrators/shared/SampledLights.h"

#include <cstdint>
#include <functional>
#include <limits>

namespace osgRayTrace::engine
{

/// RenderSession::render returns when the first of these limits is reached.
struct StopRule
{
    int passes =
        std::numeric_limits<int>::max(); ///< accumulated passes, those of earlier calls included
    int newPasses = std::numeric_limits<int>::max(); ///< of this call
    /// Tiles of this call, summed over its passes; the next render() does the rest of a pass. Tiles
    /// are then taken in an order that is even over the image.
    int newTiles = std::numeric_limits<int>::max();
    /// Of this call, looked at between passes: these are whole, and at least one is made. A limit
    /// that holds within passes is over.
    double seconds = std::numeric_limits<double>::infinity();
    double relativeError =
        0.0; ///< estimated, see RenderProgress; of the accumulated image; 0: not used
    /// If set: asked before each tile, by any thread, and before each pass but the first of the
    /// call. True: no more are begun; those that have the pass keep it, and the next render() does
    /// the rest, as after cancel(). Tiles are then taken in an order that is even over the image,
    /// so that any part of them tells what all of them cost. tiles: begun by this call; seconds:
    /// the least time until it is asked again, known of photons.
    std::function<bool(int tiles, double seconds)> shouldStop;
    /// With over: tiles along a side of the squares whose tiles follow each other, see TileOrder.
    /// These squares, and not tiles, are what is even over the image then.
    int groupedTiles = 1;
};

/// Why photons do not do what one may expect of them.
enum class PhotonNote : uint8_t
{
    None,
    NoPower,       ///< no light has any: none were emitted
    NoneStored,    ///< they were followed, but met no surface that scatters light
    RadiusLimited, ///< the radius that was set is below the spacing of floats, or larger than the
                   ///< scene
};

struct RayCounts
{
    uint64_t camera = 0;
    uint64_t shadow = 0;
    uint64_t secondary = 0; ///< mirror, glass and bounce rays
    uint64_t photon = 0;    ///< from the lights, of passes that this view looked up photons of
    uint64_t total() const { return camera + shadow + secondary + photon; }
};

/// How far the accumulated image has come.
struct RenderProgress
{
    Status status;
    IntegratorKind integrator = IntegratorKind::Automatic; ///< the one that was chosen
    int passes = 0;                                        ///< complete ones
    double seconds = 0.0;                                  ///< spent in passes since the restart
    /// Last estimate of sqrt(mean((x - r)^2 / (R^2 + 0.01))) over pixels and RGB, r the converged
    /// image and R its mean over the pixel's tile of 16 x 16: an error in terms of the brightness
    /// around. Infinite below 2 passes. Made after each pass if the rule or keepGoing asks for it.
    double relativeError = std::numeric_limits<double>::infinity();
    RayCounts rays;
    uint64_t droppedSamples = 0; ///< not finite, or above 1e30: left out of the image and counted
    bool restarted = false;      ///< this call began a new image
    int newTiles = 0;            ///< of this call, summed over its passes
    double imageShare = 0.0;     ///< of the tiles: those that have a pass; 1 as soon as passes is
    SampledLightCounts lights;   ///< of its passes
    double photonSeconds = 0.0;  ///< that photons took in this call, traced or waited for
    double firstPhotonSeconds = 0.0;          ///< of these, those of its first pass
    float photonRadius = 0.0f;                ///< of the last pass [length]; 0 without photons
    PhotonNote photonNote = PhotonNote::None; ///< of all passes together
    uint64_t storedPhotons = 0;               ///< in the map of the last pass
    uint64_t photonBytes = 0;                 ///< of the maps that are kept, for all views
    uint64_t hitPointBytes =
        0; ///< that this view keeps for photons: hit points, radii, statistics of pixels
};

} // namespace osgRayTrace::engine
