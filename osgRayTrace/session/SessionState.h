// SessionState.h - what a RenderSession is made of: the image, and what it is of. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/ThreadSeam.h"
#include "osgRayTrace/film/PassSums.h"
#include "osgRayTrace/film/TileOrder.h"
#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/session/DisplayTarget.h"
#include "osgRayTrace/session/PhotonState.h"
#include "osgRayTrace/session/RenderProgress.h"
#include "osgRayTrace/session/TileHelp.h"
#include "osgRayTrace/session/image/SurfaceMap.h"

#include <atomic>
#include <functional>
#include <memory>
#include <optional>

namespace osgRayTrace::engine
{

class SkyPortals;
struct TileSamples;

struct SessionState
{
    SessionState(std::shared_ptr<Workers> w, std::shared_ptr<PhotonPasses> p)
        : workers(std::move(w)), photons(p ? std::move(p) : std::make_shared<PhotonPasses>())
    {
    }

    /// A pass to make.
    struct NextPass
    {
        int number;
        bool isLearning; ///< true: the image does not get it, but later passes depend on it
    };

    bool begin();
    bool beginView();
    std::optional<int> askForPass(const StopRule& rule) const;
    NextPass nextPass() const;
    void learnAnew();
    TileCounts renderTile(const PassContext& context, const Integrator& integrator,
                          const NextPass& pass, int tile);
    bool renderPass(const PassContext& context, const Integrator& integrator, const NextPass& pass,
                    const StopRule& rule, const DisplayTarget* display);
    TileCounts takeTile(const PassContext& context, const NextPass& pass, int tile,
                        const TracedTile& traced);
    TilePhotons tilePhotons(int tile, int pass);
    void takePhotons(int tile, int pass, const TilePhotons& traced, float alpha, RgbaLanes* rgba);
    HelpedPass helpedPass(const PassContext& context, const NextPass& pass) const;
    std::unique_ptr<PassHelp> helpWith(const PassContext& context, const NextPass& pass,
                                       const SharedTiles& tiles) const;
    void renderWithHelp(PassHelp& passHelp, std::size_t places,
                        const std::function<void()>& takeOne,
                        const std::function<void(int)>& trace);
    void finishPass(const PassContext& context, const NextPass& pass, PassSet&& passes);
    void preparePhotons(PassContext& context, int pass);
    void preparePortals(PassContext& context, int pass);
    TileCounts sampleTile(const PassContext& context, const Integrator& integrator, int number,
                          TileSamples& tile) const;
    void samplePixels(std::vector<TileSamples>& tiles, const std::function<bool()>& shouldStop);
    ErrorEstimate estimateError() const;
    void addTileCounts();
    double imageShare() const;
    bool hasAllDepths() const { return film.passes() > 0 || filmContinues; }
    RenderProgress run(const StopRule& rule,
                       const std::function<bool(const RenderProgress&)>& keepGoing,
                       const DisplayTarget* display);
    void takePose(const StopRule& rule, int pass);
    void finishSurfaces();
    void findSurfaces();
    void resetFilm(bool continues, const PassSums* sums);
    std::vector<std::size_t> firstPassOrder(const TileOrder& order,
                                            const std::vector<uint8_t>& firstTiles) const;
    void resolve(const DisplayTarget& display, bool over) const;
    void resolveTile(const DisplayTarget& display, int tile) const;
    void resolveRest(const DisplayTarget& display);
    PassContext contextOfPass(int pass) const;
    PassContext contextOf(const NextPass& pass) const;
    std::optional<PassContext> contextOfSize(int width, int height) const;

    std::shared_ptr<Workers> workers;
    std::shared_ptr<TileHelp> help; // null: all tiles are traced here

    // These values are wanted next.
    std::shared_ptr<const TracedScene> scene;
    View view;
    RenderOptions options;
    uint32_t sequence = 0;
    bool keepsSurfaces = false;
    bool continuesView = false; // whether the next image keeps depths and surfaces of its view
    bool centred = false;
    FilmSums sumsKind = FilmSums::Fast;
    int firstPass = 0;
    std::optional<PassSums> firstSums; // sums that the next image begins with

    // These values describe what the film holds.
    std::shared_ptr<const TracedScene> filmScene;
    View filmView;
    RenderOptions filmOptions;
    uint32_t filmSeed = 0; // seed of the options and the sequence
    bool filmCentred = false;
    CameraRays camera;
    std::vector<Light> placedLights; // the lights, placed; empty: those of the scene
    std::vector<EnvironmentStratum> strata;
    std::optional<std::shared_ptr<const SkyPortals>> portals; // null: none; empty: not looked for
    Film film;
    PassSet filmPasses;            // the whole passes of the film
    std::optional<int> wantedPass; // the next one that the film is to get
    int filmFirstPass = 0;         // passes before it are not the film's
    int tracedPasses = 0; // of the first passes, those that this session has traced for the film
    int ownPasses = 0;    // passes of the film that this session has added
    std::vector<int> learntPasses; // by tile: learning passes that it has had; empty: none
    bool filmContinues = false;    // whether tiles without a pass have depths of the image before
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
