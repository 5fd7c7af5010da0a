// PhotonState.h - the state that a view keeps for photon mapping from pass to pass. Layer: session.
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

/// What a tile saw of the photons of one bin of PhotonGuide.
struct SeenSquares
{
    uint32_t bin;
    double squares; ///< sum of the squares of what each of the photons added
};

/// Chooses radii, and holds the photons of the pass at work and, for the local schedule, the
/// statistics of each pixel. Each pixel's first radius is the given one. If none is given, it is
/// the smallest with kRadiusPhotons photons (radiusOf), from the width of a pixel up to the radius
/// that holds kDensityPhotons photons around a photon in the median. Later radii follow the
/// schedule. If the first pass that is guided to views has more photons around a pixel, the pixel's
/// radius becomes smaller by the same rule. All radii are kept between the spacing of floats and
/// the radius of the scene.
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

    /// Begins a new image. tileCount: of the film.
    void reset(int tileCount);

    /// Traces or finds the photons of a pass and sets them in context, whose integrator is chosen.
    /// Does nothing for integrators without photons.
    void prepare(const std::shared_ptr<const TracedScene>& traced, PassContext& context, int pass,
                 const Workers& workers);

    /// Records what a whole pass saw of its photons. To be called before the view's next pass, so
    /// that views which take turns know of each other when photons are guided.
    void finish(const std::shared_ptr<const TracedScene>& traced, const PassContext& context,
                int pass);

    /// Returns the least time that prepare will take for a pass, as the last photons that were
    /// traced suggest it [s]; 0 for photons that are kept.
    double secondsOf(int pass) const;

    bool active() const { return _pass != nullptr; }

    /// Returns the tile's hit points for the half of the film that the pass belongs to, if passes
    /// share camera paths, as those of Ppm do; else null. The hit points of a tile are dropped if
    /// they are more than its share of kMostHitPointBytes: then its paths are followed again.
    HitPoints* hitPoints(int tile, int pass);
    static constexpr std::size_t kMostHitPointBytes = std::size_t(1) << 29;

    /// begin sets the radii for the tile before its pass; end takes what the pass has found. For
    /// the local schedule, end adds the photons' radiance to rgba.
    void begin(int tile, int pass, GatheredPhotons& gathered);
    void end(int tile, int pass, const GatheredPhotons& gathered, float alpha, RgbaLanes* rgba);

    float radius() const { return _largest * _shrink; } ///< largest of the last pass [length]
    PhotonNote note() const;
    const PhotonPass* photons() const { return _pass.get(); }
    std::size_t keptBytes() const
    {
        return _passes->bytes();
    }                              ///< memory of photon maps, of all views
    std::size_t viewBytes() const; ///< memory of hit points, radii and statistics of the pixels

private:
    void chooseRadii(const PhotonScene& scene, const PassContext& context, const Workers& workers);
    void sumUpSeen();
    bool choosesAgain(int pass) const { return pass == PhotonPasses::kFirst && _guides && !_local; }

    std::shared_ptr<PhotonPasses> _passes;
    ViewId _view;
    std::shared_ptr<const PhotonPass> _pass;
    // Radii [length]
    float _floor = 0.0f;      ///< none is smaller
    float _least = 0.0f;      ///< least first radius; 0: not chosen yet
    float _largest = 0.0f;    ///< largest first radius
    float _cellRadius = 0.0f; ///< half the size of the map's cells in the first pass
    float _shrink = 1.0f; ///< radius of the pass at work over that of the first, global schedule
    bool _local = false;
    bool _idle = false;    ///< there are no caustics: all paths are traced from the eye
    bool _dark = false;    ///< there are photons to emit, but no light has power
    bool _limited = false; ///< the radius that was set is not the one in use
    bool _stored = false;  ///< some pass has stored photons
    bool _guides =
        false; ///< from PhotonPasses::kFirst on, photons are guided to what this view saw
    int _preparedPass = -1;
    std::size_t _pixels = 0;                  ///< number of pixels of all tiles
    std::vector<float> _firstRadii;           ///< by tile, pixel; 0: not known; empty if local
    std::vector<LocalStatistics> _statistics; ///< by half, tile, pixel; empty unless local
    std::vector<HitPoints> _hitPoints;        ///< by half, tile; empty unless passes share paths
    /// By tile: what the pass at work saw; empty unless photons are guided to it.
    std::vector<std::vector<SeenSquares>> _seen;
    std::vector<double> _seenSquares; ///< sums over passes: see PhotonPasses::recordSeen
};

} // namespace osgRayTrace::engine
