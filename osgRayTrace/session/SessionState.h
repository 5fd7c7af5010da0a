// SessionState.h - what a RenderSession is made of: the image, and what it is of. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/ThreadSeam.h"
#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/film/TileOrder.h"
#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/session/DisplayTarget.h"
#include "osgRayTrace/session/PhotonState.h"
#include "osgRayTrace/session/RenderProgress.h"
#include "osgRayTrace/session/image/SurfaceMap.h"

#include <atomic>
#include <optional>

namespace osgRayTrace::engine
{

struct SessionState
{
    SessionState(std::shared_ptr<Workers> w, std::shared_ptr<PhotonPasses> p)
        : workers(std::move(w)), photons(p ? std::move(p) : std::make_shared<PhotonPasses>())
    {
    }

    bool begin();
    TileCounts renderTile(const PassContext& context, const Integrator& integrator, int tile);
    bool renderPass(const PassContext& context, const Integrator& integrator, const StopRule& rule,
                    const DisplayTarget* display);
    void preparePhotons(PassContext& context, int pass);
    ErrorEstimate estimateError() const;
    void addTileCounts();
    double imageShare() const;
    bool hasAllDepths() const { return film.passes() > 0 || filmContinues; }
    RenderProgress run(const StopRule& rule,
                       const std::function<bool(const RenderProgress&)>& keepGoing,
                       const DisplayTarget* display);
    void finishSurfaces();
    void findSurfaces();
    void resetFilm(bool continues);
    std::vector<std::size_t> firstPassOrder(const TileOrder& order,
                                            const std::vector<uint8_t>& firstTiles) const;
    void resolve(const DisplayTarget& display, bool over) const;
    void resolveTile(const DisplayTarget& display, int tile) const;
    void resolveRest(const DisplayTarget& display);
    PassContext contextOfPass(int pass) const;
    std::optional<PassContext> contextOfSize(int width, int height) const;

    std::shared_ptr<Workers> workers;

    // These values are wanted next.
    std::shared_ptr<const TracedScene> scene;
    View view;
    RenderOptions options;
    uint32_t sequence = 0;
    bool keepsSurfaces = false;
    bool continuesView = false; // whether the next image keeps depths and surfaces of its view
    bool centred = false;

    // These values describe what the film holds.
    std::shared_ptr<const TracedScene> filmScene;
    View filmView;
    RenderOptions filmOptions;
    uint32_t filmSeed = 0; // seed of the options and the sequence
    bool filmCentred = false;
    CameraRays camera;
    std::vector<Light> placedLights; // the lights, placed; empty: those of the scene
    std::vector<EnvironmentStratum> strata;
    Film film;
    bool filmContinues = false; // whether tiles without a pass have depths of the image before
    std::vector<SurfaceSample> samples; // samples of the film's pixels, if it has them
    bool hasSamples = false;            // whether the film has samples, or will with its first pass
    SurfaceMap surfaces, lastSurfaces;
    PhotonState photons;
    RenderProgress progress;
    std::vector<TileCounts> tileCounts; // counts of the pass that is rendered
    std::vector<uint16_t> tileAges;     // images of the same view since a tile had a pass
    std::vector<uint8_t> dirtyTiles;    // tiles with passes of this call that the display lacks
    int photonsCounted = 0;             // passes whose photon rays are in progress

    ThreadSeam seam; ///< checks the functions of RenderSession that change it, but for cancel()

    std::atomic<bool> cancelled{false}; // any thread sets it, render() clears it, workers read it
};

} // namespace osgRayTrace::engine
