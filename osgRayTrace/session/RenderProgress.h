// RenderProgress.h - when a render stops, and how far the image has come. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Status.h"
#include "osgRayTrace/film/ErrorEstimate.h"
#include "osgRayTrace/integrators/shared/RenderOptions.h"
#include "osgRayTrace/integrators/shared/SampledLights.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace osgRayTrace::engine
{

/// RenderSession::render returns when the first of these limits is reached.
struct StopRule
{
    /// Limit of the accumulated passes, which include those of earlier calls: no pass of this
    /// number or a higher one is made.
    int passes = std::numeric_limits<int>::max();
    int newPasses = std::numeric_limits<int>::max(); ///< passes of this call
    /// Limit of the tiles of this call, summed over its passes; the next render() does the rest of
    /// a pass. Tiles are then taken in an order that is even over the image.
    int newTiles = std::numeric_limits<int>::max();
    /// Limit of the seconds of this call. The clock is read between passes, which stay whole, and
    /// one pass at least is made. shouldStop serves a limit that holds within passes.
    double seconds = std::numeric_limits<double>::infinity();
    /// Limit of ErrorEstimate::relative of the accumulated image; 0 means that it is not used.
    double relativeError = 0.0;
    /// If shouldStop is set, any thread asks it before each tile, and render() asks it before each
    /// pass but the first of the call. If it returns true, no more tiles are begun; the tiles that
    /// have the pass keep it, and the next render() does the rest, as after cancel(). Tiles are
    /// then taken in an order that is even over the image, so that any part of the tiles tells what
    /// all of them cost. tiles is the number of tiles begun by this call; seconds is the least time
    /// until the next question, known of photons.
    std::function<bool(int tiles, double seconds)> shouldStop;
    /// With shouldStop, groupedTiles is the number of tiles along a side of the squares whose tiles
    /// follow each other, see TileOrder. These squares, and not tiles, are then even over the
    /// image.
    int groupedTiles = 1;
    /// With shouldStop, the tiles that the first pass of the image takes before all others, by a
    /// mark each; after these the tiles come first that had no pass for the longest time. May be
    /// null.
    const std::vector<uint8_t>* firstTiles = nullptr;
    /// If nextPass is set, it tells the passes that the image gets, in place of all from the first
    /// one on. render() asks it on its thread, between passes; a number is above all before it. The
    /// render ends with a number that is negative, or that the image has. Errors are then estimated
    /// for relativeError alone.
    std::function<int()> nextPass;
    /// If pose is set, render() calls it on its thread before each pass, and before it goes on with
    /// one: it may set another scene and view of the same size, which the pass then shows. The
    /// options are moving.
    std::function<void(int pass)> pose;
};

/// What an image with media leaves out.
enum class MediumNote : uint8_t
{
    None,
    PathsInstead, ///< photons were asked for that bring all light, and a medium emits
    SingleOnly,   ///< Whitted's integrator has single scattering alone
    DiffuseOnly,  ///< Whitted's integrator has no light below surfaces
};

/// The reasons why photons have less effect than a user may expect.
enum class PhotonNote : uint8_t
{
    None,
    NoPower,    ///< no light has any power: no photons were emitted
    NoneStored, ///< photons were followed, but met no surface that scatters light
    /// the radius that was set is below the spacing of floats, or larger than the scene
    RadiusLimited,
    /// the first passes saw next to nothing of the photons' light: paths find all light since then
    Ended,
};

struct RayCounts
{
    uint64_t camera = 0;
    uint64_t shadow = 0;
    uint64_t secondary = 0; ///< mirror, glass and bounce rays
    uint64_t photon = 0;    ///< from the lights, in passes whose photons this view has looked up
    uint64_t total() const { return camera + shadow + secondary + photon; }
};

/// How far the accumulated image has come.
struct RenderProgress
{
    Status status;
    /// The integrator that was chosen. It is PhotonCaustics, too, if photonNote is Ended.
    IntegratorKind integrator = IntegratorKind::Automatic;
    int passes = 0;       ///< complete passes
    double seconds = 0.0; ///< time spent in passes since the restart
    /// Last estimate of the image's error. It is made after each pass if the rule asks for an
    /// error. If there is a keepGoing and no nextPass, it is that of 4 / 5 of the passes at least,
    /// and of all at the end.
    ErrorEstimate error;
    RayCounts rays;
    MediumNote mediumNote = MediumNote::None;
    uint64_t collisions = 0;     ///< with media
    uint64_t cutWalks = 0;       ///< paths that ended within a medium: see kMostCollisions
    uint64_t openWalks = 0;      ///< walks below surfaces that have left their mesh
    uint64_t droppedSamples = 0; ///< samples left out: not finite, or above 1e30
    bool restarted = false;      ///< whether this call began a new image
    int newTiles = 0;            ///< tiles of this call, summed over its passes
    double imageShare = 0.0;     ///< share of the tiles that have a pass; 1 as soon as passes is
    SampledLightCounts lights;   ///< lights sampled in the image's passes
    double photonSeconds = 0.0;  ///< time of photons in this call, traced or waited for
    double firstPhotonSeconds = 0.0; ///< the part of photonSeconds in the first pass of this call
    float photonRadius = 0.0f;       ///< radius of the last pass [length]; 0 without photons
    PhotonNote photonNote = PhotonNote::None; ///< the note on all passes together
    uint64_t storedPhotons = 0;               ///< photons in the map of the last pass; 0: none
    uint64_t storedBeams = 0;                 ///< beams of the last pass, in media
    uint64_t storedPoints = 0;                ///< photons of the last pass at points within media
    float beamRadius = 0.0f;                  ///< of the last pass [length]; 0 without beams
    uint64_t photonBytes = 0;                 ///< memory of photons, which all views share
    /// Memory that this view keeps for photons: hit points, radii, look-ups and first passes.
    uint64_t hitPointBytes = 0;
};

} // namespace osgRayTrace::engine
