// PhotonState.h - what a view keeps for photon mapping from pass to pass. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/HitPoints.h"
#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/photons/RadiusSchedule.h"
#include "osgRayTrace/session/RenderProgress.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;

/// What a tile saw of the photons that were guided to a bin of PhotonGuide.
struct SeenSquares
{
    uint32_t bin;
    double squares; ///< sum of the squares of what each of them added
};

/// Chooses radii, holds the photons of the pass at work and, for the local schedule, the statistics
/// of each pixel. Each pixel's first radius is the given one, or the smallest with kRadiusPhotons
/// photons (radiusOf) from the width of a pixel up to the radius that holds kDensityPhotons photons
/// around a photon in the median. Later radii follow the schedule; where the first pass that is
/// guided to views has more photons, they become smaller by the same rule. All are kept between the
/// spacing of floats and the radius of the scene.
class PhotonState
{
public:
    explicit PhotonState(std::shared_ptr<PhotonPasses> passes)
        : _passes(std::move(passes)), _view(_passes->newView())
    {
    }
    ~PhotonState() { _passes->forgetSeen(_view); }
    PhotonState(const PhotonState&) = delete;
    PhotonState& operator=(const PhotonState&) = delete;

    /// A new image. tileCount: of the film.
    void reset(int tileCount);

    /// Traces or finds the photons of a pass and sets them in context, whose integrator is chosen.
    /// Nothing to do for integrators without photons.
    void prepare(const std::shared_ptr<const TracedScene>& traced, PassContext& context, int pass,
                 const Workers& workers);

    /// After a pass that is whole: what it saw of its photons. Before the view's next pass, so that
    /// views which take turns know of each other when photons are guided.
    void finish(const std::shared_ptr<const TracedScene>& traced, const PassContext& context,
                int pass);

    /// What prepare will take at least for a pass, going by the last photons that were traced; 0
    /// for photons that are kept.
    double secondsOf(int pass) const;

    bool active() const { return _pass != nullptr; }

    /// The tile's hit points for the half of the film that the pass belongs to, if passes share
    /// camera paths, as those of Ppm do; else null. What a tile has of them goes if it is more than
    /// its share of kMostHitPointBytes: its paths are followed again then.
    HitPoints* hitPoints(int tile, int pass);
    static constexpr std::size_t kMostHitPointBytes = std::size_t(1) << 29;

    /// Radii for the tile before its pass; and what it found. For the local schedule that is added
    /// to rgba.
    void begin(int tile, int pass, GatheredPhotons& gathered);
    void end(int tile, int pass, const GatheredPhotons& gathered, float alpha, RgbaLanes* rgba);

    float radius() const { return _largest * _shrink; } ///< largest of the last pass [length]
    PhotonNote note() const;
    const PhotonPass* photons() const { return _pass.get(); }
    std::size_t keptBytes() const { return _passes->bytes(); } ///< of photon maps, for all views
    std::size_t viewBytes() const; ///< of hit points, radii and statistics of the pixels

private:
    void chooseRadii(const PhotonScene& scene, const PassContext& context, const Workers& workers);
    void sumUpSeen();
    bool choosesAgain(int pass) const { return pass == PhotonPasses::kFirst && _guides && !_local; }

    std::shared_ptr<PhotonPasses> _passes;
    ViewId _view;
    std::shared_ptr<const PhotonPass> _pass;
    // Radii [length]
    float _floor = 0.0f; ///< none is smaller
    float _least = 0.0f; ///< of first radii; 0: not chosen yet
    float _largest = 0.0f;
    float _cellRadius = 0.0f; ///< half the size of the map's cells in the first pass
    float _shrink = 1.0f;     ///< of the pass at work against the first, global schedule
    bool _local = false;
    bool _idle =
        false; ///< photons for caustics, but there are none: all paths are traced from the eye
    bool _dark = false;    ///< there are photons to emit, but no light has power
    bool _limited = false; ///< the radius that was set is not the one in use
    bool _stored = false;  ///< some pass has
    bool _guides =
        false; ///< from pass PhotonPasses::kFirst on photons are guided to what this view has seen
    int _preparedPass = -1;
    std::size_t _pixels = 0;                  ///< of all tiles
    std::vector<float> _firstRadii;           ///< tile, pixel; 0: not known; empty if local
    std::vector<LocalStatistics> _statistics; ///< half, tile, pixel; empty unless local
    std::vector<HitPoints> _hitPoints;        ///< half, tile; empty unless passes share paths
    std::vector<std::vector<SeenSquares>>
        _seen;                        ///< tile; of the pass at work; empty unless it is learnt from
    std::vector<double> _seenSquares; ///< of all those passes: see PhotonPasses::recordSeen
};

} // namespace osgRayTrace::engine
