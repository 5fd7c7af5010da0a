// PhotonPasses.h - photon maps by pass, traced once for all views. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/PhotonMap.h"
#include "osgRayTrace/photons/PhotonTracer.h"

#include <array>
#include <memory>
#include <mutex>

namespace osgRayTrace::engine
{

/// The photons of one pass. Immutable.
struct PhotonPass
{
    PhotonMap map;
    uint64_t rays = 0;
    uint64_t dropped = 0;
    double seconds = 0.0; ///< to trace and to sort
};

constexpr int kDensityPhotons = 16;

/// What the radii of lookups are chosen by [length].
struct PhotonDensity
{
    float radius = 0.0f; ///< holds kDensityPhotons photons of a pass around a photon, in the median
    float sceneRadius = 0.0f;       ///< of a sphere that holds the scene
    float largestCoordinate = 0.0f; ///< in it, absolute
    bool emits = false;             ///< some light has power
    bool caustics = false;          ///< something can make them
    std::size_t guideBins = 0;      ///< of PhotonGuide; 0: there is nothing to learn
};

/// Thread safe: views that ask for the same pass at once wait for one of them to trace it. Kept are
/// the last few passes, which views that are rendered in turns share, and the first few, which each
/// new image begins with: a camera that moves needs no new photons. Of these as many as kMostBytes
/// have room for.
///
/// The first kFirst passes are guided by the scene alone. Views record what they see of them, and
/// with PhotonPassOptions::photonGuiding all later passes are guided to what the views that have
/// done so see: a pass is an unbiased estimate by itself, whatever it is guided to, as nothing in
/// its guide comes from its own photons. So it depends on the views, and on the order in which they
/// come: two processes trace the same photons from kFirst on only if they show the same views;
/// without photonGuiding always. A view that starts anew takes back what it recorded.
class PhotonPasses
{
public:
    /// Of the first pass.
    PhotonDensity density(const std::shared_ptr<const TracedScene>& traced,
                          const std::vector<Light>& lights, const PhotonPassOptions& options,
                          const Workers& workers);

    /// Photons of pass number index, in cells of this size.
    std::shared_ptr<const PhotonPass> pass(const std::shared_ptr<const TracedScene>& traced,
                                           const std::vector<Light>& lights,
                                           const PhotonPassOptions& options, int index,
                                           float cellSize, const Workers& workers);

    /// What a view saw of all of the first passes: sums over some of its pixels of the squares of
    /// what single photons added to them, by bin. view: its name until it forgets.
    void recordSeen(const std::shared_ptr<const TracedScene>& traced,
                    const std::vector<Light>& lights, const PhotonPassOptions& options,
                    const void* view, std::vector<double> squares);
    void forgetSeen(const void* view);

    /// Whether there are photons of a pass now. Not while some are traced: who would have to wait
    /// for them is told false.
    bool keeps(int index) const;

    uint64_t tracedRays() const; ///< of all passes that were traced
    std::size_t bytes() const;   ///< of the maps that are kept
    static constexpr std::size_t kMostBytes = std::size_t(1) << 29;
    static constexpr int kFirst = 4; ///< passes that each image begins with

private:
    struct Entry
    {
        int index = -1;
        float cellSize = 0.0f;
        std::shared_ptr<const PhotonGuide> photonGuide;
        std::shared_ptr<const PhotonPass> pass;
    };
    struct Seen
    {
        const void* view;
        std::vector<double> squares; ///< a bin
    };
    static constexpr int kLast = 4;

    TracedPhotons trace(int index, const PhotonGuide* photonGuide, const Workers& workers);
    std::shared_ptr<const PhotonGuide> guideOf(int index);
    void keep(Entry entry);
    std::size_t keptBytes() const;

    void begin(const std::shared_ptr<const TracedScene>& traced, const std::vector<Light>& lights,
               const PhotonPassOptions& options);
    bool isCurrent(const std::shared_ptr<const TracedScene>& traced,
                   const std::vector<Light>& lights, const PhotonPassOptions& options) const;

    mutable std::mutex _mutex; // everything below
    std::shared_ptr<const TracedScene> _traced;
    std::vector<Light> _placed; ///< the lights, if they are others than those of the scene
    const std::vector<Light>* _lights = nullptr; ///< of the scene, or _placed
    PhotonPassOptions _options;
    std::unique_ptr<PhotonEmitter> _emitter;
    std::unique_ptr<TracedPhotons> _first; ///< of density(), for the first pass
    std::unique_ptr<PhotonDensity> _density;
    std::vector<Entry> _kept;                           ///< oldest first
    std::array<std::vector<uint32_t>, kFirst> _emitted; ///< photons that were guided to a bin; pass
    std::vector<Seen> _seen;                            ///< in the order of noting
    std::shared_ptr<const PhotonGuide> _photonGuide;    ///< made of it; null: not yet
    uint64_t _tracedRays = 0;
};

} // namespace osgRayTrace::engine
