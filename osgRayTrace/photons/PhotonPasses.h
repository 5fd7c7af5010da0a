// PhotonPasses.h - photon maps by pass, traced once for all views. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/CheckedMutex.h"
#include "osgRayTrace/photons/PhotonMap.h"
#include "osgRayTrace/photons/PhotonMapMemory.h"
#include "osgRayTrace/photons/PhotonOpenings.h"
#include "osgRayTrace/photons/PhotonTracer.h"
#include "osgRayTrace/photons/VolumePhotons.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

namespace osgRayTrace::engine
{

/// Holds what photons are traced for: a scene, its lights as a view places them, and the options.
/// Passes belong to one PhotonScene at a time, and views with equal ones share the passes.
struct PhotonScene
{
    std::shared_ptr<const TracedScene> traced;
    const std::vector<Light>* lights = nullptr; ///< the scene's own, or those placed for a view
    PhotonPassOptions options;
};

/// Returns whether both have the same photons. A traced scene never changes, so it is compared by
/// its identity, and so are lights that are the scene's own: there may be millions.
bool samePhotons(const PhotonScene& a, const PhotonScene& b);

/// Names a view to PhotonPasses: see PhotonPasses::newView.
enum class ViewId : uint64_t
{
};

/// Holds the photons of one pass, which never change.
struct PhotonPass
{
    PhotonMap map;
    VolumePhotons volume;
    uint64_t rays = 0;
    uint64_t dropped = 0;
    uint64_t cutWalks = 0;    ///< photons that ended within a medium
    uint64_t openWalks = 0;   ///< walks below surfaces that have left their mesh
    double seconds = 0.0;     ///< time to trace and to sort
    bool hasOpenings = false; ///< photons were sent through PhotonOpenings
};

constexpr int kDensityPhotons = 16;

/// Holds the lengths by which the radii of look-ups are chosen.
struct PhotonDensity
{
    float radius = 0.0f; ///< holds kDensityPhotons photons of a pass around a photon, in the median
    float beamRadius = 0.0f;        ///< holds kDensityPhotons beams around a line, in the median
    float pointRadius = 0.0f;       ///< the same for collisions with dense media as radius
    float sceneRadius = 0.0f;       ///< radius of a sphere that holds the scene
    float largestCoordinate = 0.0f; ///< largest absolute coordinate in that sphere
    bool emits = false;             ///< some light has power
    bool caustics = false;          ///< something in the scene can make caustics
    std::size_t guideBins = 0;      ///< number of PhotonGuide's bins; 0: there is nothing to learn
};

/// Traces the passes of photons, once for all views, and keeps some of them. Thread safe: views
/// that ask for the same pass at once wait for one of them to trace it. The last few passes are
/// kept, which views that are rendered in turns share, and the first few, with which each new image
/// begins: a camera that moves needs no new photons. kMostBytes limits how many are kept.
///
/// The first kFirst passes are guided by the scene alone. Views record what they see of these, and
/// with PhotonPassOptions::photonGuiding all later passes are guided to what the views that have
/// recorded see. A pass is an unbiased estimate by itself, whatever it is guided to, as nothing in
/// its guide comes from its own photons. So a later pass depends on the views and on their order:
/// two processes trace the same photons from kFirst on only if they show the same views. Without
/// photonGuiding they always do. A view that starts anew takes back what it recorded.
///
/// With photonGuiding and PhotonUse::Indirect, passes from kFirst on are also sent through
/// PhotonOpenings, if photons of their own tell that little of what views see is reached otherwise.
/// What was said of the guide is true of openings, too: they depend on what views saw of the first
/// pass.
class PhotonPasses
{
public:
    /// Returns the density of the photons of the first pass.
    PhotonDensity density(const PhotonScene& scene, const Workers& workers);

    /// Returns the photons of pass number index, in cells of cellSize [length].
    std::shared_ptr<const PhotonPass> pass(const PhotonScene& scene, int index, float cellSize,
                                           const Workers& workers);

    /// Returns a name that no other view has.
    ViewId newView();

    /// Records what a view saw of all of the first passes. squares: by bin, sums over some of the
    /// view's pixels of the squares of what single photons added to them.
    void recordSeen(const PhotonScene& scene, ViewId view, std::vector<double> squares);

    /// Records points at which a view looked up photons in the first pass.
    void recordPoints(const PhotonScene& scene, ViewId view, std::vector<SeenPoint> points);

    /// Takes back all that a view has recorded.
    void forgetSeen(ViewId view);

    /// Returns whether photons of a pass are kept. False also while a pass is being traced, as the
    /// caller would have to wait to learn it.
    bool keeps(int index) const;

    uint64_t tracedRays() const; ///< rays of all passes that were traced
    /// Returns the memory of the maps that are kept, and of what the next passes use again: blocks
    /// of photons, a map, and flights from which openings are learnt.
    std::size_t bytes() const;
    static constexpr std::size_t kMostBytes = std::size_t(1) << 29;
    static constexpr int kFirst = 4; ///< number of passes that each image begins with

private:
    struct Entry
    {
        int index = -1;
        float cellSize = 0.0f;
        std::shared_ptr<const PhotonGuide> photonGuide;
        std::shared_ptr<const PhotonOpenings> openings;
        std::shared_ptr<const PhotonPass> pass;
    };
    struct Seen
    {
        ViewId view;
        std::vector<double> squares; ///< by bin
    };
    struct SeenPoints
    {
        ViewId view;
        std::vector<SeenPoint> points;
    };
    static constexpr int kLast = 4;

    TracedPhotons trace(int index, const PhotonGuide* photonGuide, const PhotonOpenings* openings,
                        const Workers& workers);
    std::shared_ptr<const PhotonGuide> guideOf(int index);
    std::shared_ptr<const PhotonOpenings> openingsOf(int index, const Workers& workers);
    void keep(Entry entry);
    std::size_t keptBytes() const;

    void begin(const PhotonScene& scene);

    std::atomic<uint64_t> _views{0}; ///< number of names given; views are made while others trace
    mutable CheckedMutex _mutex;     // guards everything below
    PhotonScene _scene;         ///< of all photons below; its lights are the scene's own or _placed
    std::vector<Light> _placed; ///< a copy of the lights unless they are the scene's own
    std::unique_ptr<PhotonEmitter> _emitter; ///< null: there is no scene yet
    PhotonMemory _memory;                    ///< of the photons of _first, and of a pass's
    /// Holds the memory of the next map. Passes that views hold may outlive this object.
    const std::shared_ptr<PhotonMapMemory> _mapMemory = std::make_shared<PhotonMapMemory>();
    std::unique_ptr<TracedPhotons> _first; ///< traced by density(), for the first pass
    std::unique_ptr<PhotonDensity> _density;
    std::vector<Entry> _kept;                           ///< oldest first
    std::array<std::vector<uint32_t>, kFirst> _emitted; ///< by pass: TracedPhotons::emitted
    std::vector<Seen> _seen;                            ///< in the order of recording
    std::shared_ptr<const PhotonGuide> _photonGuide;    ///< learnt from _seen; null: not yet
    std::vector<SeenPoints> _points;                    ///< in the order of recording
    /// Flights from which openings are learnt: a few, which tell whether it is worth while, and
    /// all.
    std::vector<PhotonFlight> _fewFlights, _flights;
    std::shared_ptr<const PhotonOpenings> _openings; ///< null: none
    bool _lookedForOpenings = false;
    uint64_t _tracedRays = 0;
};

} // namespace osgRayTrace::engine
