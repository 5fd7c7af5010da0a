// PhotonState.h - the state of photon mapping that a view keeps from pass to pass. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/LazyArray.h"
#include "osgRayTrace/film/ErrorEstimate.h"
#include "osgRayTrace/integrators/shared/HitPoints.h"
#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/photons/RadiusSchedule.h"
#include "osgRayTrace/session/FirstPasses.h"
#include "osgRayTrace/session/RenderProgress.h"
#include "osgRayTrace/session/TileLookups.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;

/// Holds the contribution that a tile saw from the photons that were guided to a bin of
/// PhotonGuide.
struct SeenSquares
{
    uint32_t bin;
    double squares; ///< sum of the squares of the photons' contributions
};

/// Chooses radii, holds the photons of the pass at work and, for the local schedule, the statistics
/// of each pixel. Each pixel's first radius is the given one, or the smallest with kRadiusPhotons
/// photons (radiusOf). That radius is at least the width of a pixel and at most the radius that
/// holds kDensityPhotons photons around a photon in the median. A pixel that meets no surface in
/// the shared passes takes the mean radius of its tile. Later radii follow the schedule; if the
/// first pass that is guided to views has more photons, the radii become smaller by the same rule.
/// All radii are kept between the spacing of floats and the radius of the scene.
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

    /// Begins a new image. tileCount is the number of the film's tiles.
    void reset(int tileCount);

    /// Tells whether photons may end once the view has seen that they carry next to nothing of its
    /// light: paths find that light then.
    void setOptional(bool optional) { _optional = optional; }

    /// Chooses the least and the largest radius, unless they are chosen.
    void choose(const std::shared_ptr<const TracedScene>& traced, const PassContext& context,
                const Workers& workers);

    /// Returns on how many of the first passes all others depend, by what this view has learnt from
    /// them: radii, places to which photons are guided, and which pixels take the photons of their
    /// footprint. Known after choose().
    int sharedPasses() const;

    /// Traces or finds the photons of a pass and sets them in context, whose integrator is chosen.
    /// For integrators without photons the function does nothing.
    void prepare(const std::shared_ptr<const TracedScene>& traced, PassContext& context, int pass,
                 const Workers& workers);

    /// Records the contributions that a whole pass saw from its photons. The call comes before the
    /// view's next pass, so that views which take turns know of each other when photons are guided.
    void finish(const std::shared_ptr<const TracedScene>& traced, const PassContext& context,
                int pass);

    /// Returns the least time that prepare will take for a pass [s], estimated from the last
    /// photons that were traced; 0 for photons that are kept.
    double secondsOf(int pass) const;

    bool active() const { return _pass != nullptr; }

    /// Returns by tile what discs of other radii would have added; empty if no photons are looked
    /// up.
    const std::vector<DiscDifferences>& discDifferences() const { return _differences; }

    /// Returns by tile what pixels have learnt about the bias of their discs, for the mean of so
    /// many passes from the first one on; empty if no pixels compare discs with footprints.
    FootprintBiases footprintBiases(int passes, const Workers& workers) const;

    /// Returns the tile's hit points for the half of the film that the pass belongs to, if passes
    /// share camera paths, as those of Ppm do; otherwise null. A tile drops its hit points if they
    /// take more than its share of kMostHitPointBytes: its camera paths are then followed again.
    HitPoints* hitPoints(int tile, int pass);
    static constexpr std::size_t kMostHitPointBytes = std::size_t(1) << 29;

    /// begin sets the radii for the tile before its pass; end takes the photons that the pass
    /// gathered. With the local schedule end adds their light to rgba.
    void begin(int tile, int pass, GatheredPhotons& gathered);
    void end(int tile, int pass, const GatheredPhotons& gathered, float alpha, RgbaLanes* rgba);

    /// Returns the largest radius of the last pass [length].
    float radius() const { return _largest * _smoothShrink; }
    PhotonNote note() const;
    const PhotonPass* photons() const { return _pass.get(); }
    const std::shared_ptr<const PhotonPass>& sharedPhotons() const { return _pass; }
    float cellSize() const { return _cellSize; } ///< of the map of the pass at work [length]
    /// Returns how many bins of PhotonGuide the pass at work learns from; 0: it does not learn.
    std::size_t guideBins() const { return _seen.empty() ? 0 : _seenSquares.size(); }
    /// Returns the bytes of photon maps, for all views.
    std::size_t keptBytes() const { return _passes->bytes(); }
    std::size_t viewBytes() const; ///< bytes of hit points, radii, look-ups and first passes

private:
    void chooseRadii(const PhotonScene& scene, const PassContext& context, const Workers& workers);
    void fillRadii(std::size_t firstPixel);
    void sumUpSeen();
    void endIfUnneeded();
    bool choosesAgain(int pass) const
    {
        const bool opens = _opened && !_lookups.empty(); // else the pass is not shared
        return !_local && pass == PhotonPasses::kFirst && (_guides || opens);
    }

    std::shared_ptr<PhotonPasses> _passes;
    ViewId _view;
    std::shared_ptr<const PhotonPass> _pass;
    // The radii are lengths.
    float _floor = 0.0f; ///< least radius allowed
    float _least = 0.0f; ///< least first radius; 0: not chosen yet
    float _largest = 0.0f;
    float _cellRadius = 0.0f; ///< half the size of the map's cells in the first pass
    float _cellSize = 0.0f;
    float _beamRadius = 0.0f;   ///< of the first pass
    float _pointRadius = 0.0f;  ///< of the first pass
    float _alpha = 1.0f;        ///< of the radius schedule
    float _shrink = 1.0f;       ///< radius of the pass at work over the first one, global schedule
    float _smoothShrink = 1.0f; ///< the same where light is smooth: TileLookups::shrinksLate
    bool _local = false;
    /// True: the photons are for caustics, but nothing makes caustics, so all paths are traced from
    /// the eye.
    bool _idle = false;
    bool _causticsAlone = false;  ///< true: photons bring caustics only
    bool _optional = false;       ///< true: photons end if they carry next to nothing
    bool _ended = false;          ///< true: paths find all light from pass PhotonPasses::kFirst on
    std::vector<double> _carried; ///< by tile: carriedSquare; empty unless photons may end
    bool _dark = false;           ///< true: photons are emitted, but no light has power
    bool _limited = false;        ///< true: the radius that was set is not the one in use
    bool _stored = false;         ///< true: some pass has stored photons
    /// True: from pass PhotonPasses::kFirst on photons are guided to places that this view has
    /// seen.
    bool _guides = false;
    int _preparedPass = -1;
    std::size_t _pixels = 0;                  ///< number of pixels of all tiles
    std::vector<float> _firstRadii;           ///< by tile, pixel; 0: not known; empty if local
    std::vector<LocalStatistics> _statistics; ///< by half, tile, pixel; empty unless local
    /// By tile, from its first pass on. Empty: all look-ups are discs.
    LazyArray<TileLookups> _lookups;
    PixelProjection _projection;
    std::vector<HitPoints> _hitPoints;         ///< by half, tile; empty unless passes share paths
    std::vector<DiscDifferences> _differences; ///< by tile
    /// Contributions of the pass at work, by tile; empty unless the guide learns from the pass.
    std::vector<std::vector<SeenSquares>> _seen;
    /// Sums over all passes that the guide learns from: see PhotonPasses::recordSeen.
    std::vector<double> _seenSquares;
    /// Points at which the first pass looked up photons, by tile; empty: none are recorded.
    std::vector<std::vector<SeenPoint>> _points;
    /// The light of the passes before openings, which count no more once there are some.
    FirstPasses _before;
    bool _opened = false; ///< true: the pass at work is sent through openings
};

} // namespace osgRayTrace::engine
