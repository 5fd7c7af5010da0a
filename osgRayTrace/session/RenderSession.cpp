// RenderSession.cpp - the progressive image of one view. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/RenderSession.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/Resolve.h"
#include "osgRayTrace/film/TileOrder.h"
#include "osgRayTrace/integrators/IntegratorFactory.h"
#include "osgRayTrace/session/SessionState.h"
#include "osgRayTrace/session/image/ChannelImage.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>

namespace osgRayTrace::engine
{

namespace
{

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin)
{
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// The scene's lights with those of eye space placed for the view. Empty if there are none of
/// these: there may be millions of the others, and they are good as they are.
std::vector<Light> placedLights(const Scene& scene, const View& view)
{
    const auto isEyeSpace = [](const Light& light) { return light.eyeSpace; };
    if (std::none_of(scene.lights.begin(), scene.lights.end(), isEyeSpace)) return {};
    std::vector<Light> lights = scene.lights;
    const Mat4d worldFromView = glm::inverse(view.viewFromWorld);
    const auto placed = [&](const Vec3& position) {
        return Vec3((Vec3d(worldFromView * Vec4d(Vec3d(position), 1.0)) - scene.origin) /
                    scene.unit);
    };
    for (Light& light : lights)
    {
        if (!light.eyeSpace) continue;
        light.position = placed(light.position);
        light.direction = glm::normalize(Vec3(glm::dmat3(worldFromView) * Vec3d(light.direction)));
        light.eyeSpace = false;
    }
    return lights;
}

RenderProgress failed(RenderProgress& progress, StatusCode code, const char* message)
{
    progress.status = failure(code, message);
    return progress;
}

/// Of unit axes, whatever scale the view has.
Mat3 eyeFromEngine(const View& view)
{
    glm::dmat3 axes = glm::transpose(glm::dmat3(view.viewFromWorld));
    for (int i = 0; i < 3; ++i)
        axes[i] = glm::normalize(axes[i]);
    return Mat3(glm::transpose(axes));
}

} // namespace

/// Restart or continue: decided here and nowhere else. True if there is something to render.
bool SessionState::begin()
{
    const bool sameScene = scene == filmScene;
    const bool sameSize =
        view.width == film.width() && view.height == film.height(); // not after a failure
    const bool restart =
        !sameScene || !sameSize || view != filmView || options.needsRestart(filmOptions);
    progress.restarted = restart;
    progress.status = {};
    if (!scene)
    {
        progress.status = {StatusCode::EmptyScene, "there is no scene"};
        return false;
    }
    if (!restart) return true;

    const std::optional<CameraRays> rays =
        cameraRays(view, scene->scene().origin, scene->scene().unit);
    if (!rays)
    {
        progress.status = {StatusCode::InvalidView,
                           "the view has no size, or matrices that cannot be inverted"};
        return false;
    }
    std::vector<Light> placed =
        engine::placedLights(scene->scene(), view); // before the film changes: it may throw
    std::vector<EnvironmentStratum> newStrata;
    const PlacedEnvironment* environment = scene->lights().shiningEnvironment();
    if (environment && options.environmentSampling == EnvironmentSampling::Structured)
        newStrata = environment->strata(options.environmentSamples);
    if (film.passes() > 0 && surfaces.finished) std::swap(surfaces, lastSurfaces);
    film.reset(view.width, view.height);
    photons.reset(film.tileCount());
    camera = *rays;
    filmScene = scene;
    filmView = view;
    filmOptions = options;
    filmSeed = sequence == 0 ? options.seed : hash(options.seed, sequence + 1); // 0 and 1: halves
    placedLights = std::move(placed);
    strata = std::move(newStrata);
    progress = RenderProgress();
    progress.restarted = true;
    photonsCounted = 0;
    progress.integrator = chooseIntegrator(options.integrator, scene->traits());
    hasSamples = false;
    if (options.centredFirstPass && progress.integrator != IntegratorKind::Debug)
    {
        samples.resize(static_cast<std::size_t>(view.width) *
                       static_cast<std::size_t>(view.height));
        hasSamples = true;
    }
    if (!keepsSurfaces) surfaces = lastSurfaces = SurfaceMap();
    surfaces.view = View();
    if (keepsSurfaces && progress.integrator != IntegratorKind::Debug)
        beginSurfaceMap(view, surfaces);
    return true;
}

PassContext SessionState::contextOfPass(int pass) const
{
    PassContext context;
    context.traced = filmScene.get();
    context.lights = placedLights.empty() ? &filmScene->scene().lights : &placedLights;
    context.strata = strata.empty() ? nullptr : &strata;
    context.camera = camera;
    context.width = filmView.width;
    context.height = filmView.height;
    context.eyeFromEngine = eyeFromEngine(filmView);
    context.towardsViewer = glm::transpose(context.eyeFromEngine)[2];
    context.options = filmOptions;
    context.options.integrator = progress.integrator;
    context.key = passKey(filmSeed, pass);
    const bool sharesPaths = progress.integrator == IntegratorKind::Ppm;
    const int paths = sharesPaths ? sharedPaths(pass) : pass;
    context.pathKey = passKey(filmSeed, paths);
    context.wantsDepth = pass == 0;
    context.throughCentres = filmOptions.centredFirstPass && paths == 0;
    return context;
}

/// Adds the next pass of a tile, in the film itself where that is possible.
TileCounts SessionState::renderTile(const PassContext& context, const Integrator& integrator,
                                    int tile)
{
    TileRgba local;
    TileResult result;
    RgbaLanes* inFilm = film.firstPassStorage(tile);
    result.rgba = inFilm ? inFilm : local;
    GatheredPhotons gathered;
    if (photons.active())
    {
        photons.begin(tile, film.tilePasses(tile), gathered);
        result.gathered = &gathered;
        result.hitPoints = photons.hitPoints(tile, film.tilePasses(tile));
    }
    SurfaceBlock firstHits[kTileBlocks];
    const bool keeps = context.wantsDepth && surfaces.view.width > 0;
    if (keeps) result.surfaces = firstHits;
    const bool keepsSamples = context.wantsDepth && hasSamples;
    const std::unique_ptr<SurfaceSample[]> seen(keepsSamples ? new SurfaceSample[kTilePixels]
                                                             : nullptr);
    result.samples = seen.get();
    integrator.renderTile(context, film.tileX(tile), film.tileY(tile), result);
    for (int b = 0; keeps && b < kTileBlocks; ++b)
        setBlock(film.tileX(tile) + laneX(b, 0), film.tileY(tile) + laneY(b, 0), firstHits[b],
                 surfaces);
    if (keepsSamples)
        setSurfaceSamples(seen.get(), film.tileX(tile), film.tileY(tile), film.width(),
                          film.height(), samples);
    if (photons.active())
        photons.end(tile, film.tilePasses(tile), gathered, context.options.photonAlpha,
                    result.rgba);
    if (context.wantsDepth) std::copy(result.depth, result.depth + kTilePixels, film.depth(tile));
    if (inFilm)
        film.finishPass(tile);
    else
        film.addPass(tile, local);
    return result.counts;
}

/// The photons of a pass, which may be one that an earlier call did not finish.
void SessionState::preparePhotons(PassContext& context, int pass)
{
    const Clock::time_point start = Clock::now();
    photons.prepare(filmScene, context, pass, *workers);
    progress.photonSeconds += secondsSince(start);
    progress.photonNote = photons.note();
    const PhotonPass* traced = photons.photons();
    if (!traced) return;
    progress.photonRadius = static_cast<float>(photons.radius() * filmScene->scene().unit);
    progress.storedPhotons = traced->map.size();
    progress.photonBytes = photons.keptBytes();
    if (pass < photonsCounted) return;
    progress.rays.photon += traced->rays;
    progress.droppedSamples += traced->dropped;
    photonsCounted = pass + 1;
}

/// Adds one pass to every tile that does not have it yet, and shows it. False if some still do not.
bool SessionState::renderPass(const PassContext& context, const Integrator& integrator,
                              const StopRule& rule, const DisplayTarget* display)
{
    const int pass = film.passes();
    const auto tiles = static_cast<std::size_t>(film.tileCount());
    const TileOrder order(static_cast<std::size_t>(tilesAlong(film.width())),
                          static_cast<std::size_t>(tilesAlong(film.height())),
                          static_cast<std::size_t>(rule.groupedTiles));
    std::atomic<std::size_t> next{0};
    std::atomic<int> begun{progress.newTiles};
    std::atomic<bool> over{false};
    tileCounts.assign(tiles, TileCounts());
    dirtyTiles.resize(tiles);
    film.beginPass();
    const bool partial = rule.shouldStop || rule.newTiles < std::numeric_limits<int>::max();
    const auto renderOne = [&](std::size_t index)
    {
        // Workers begin at several places at once; an order has to be kept by all of them together.
        if (partial) index = order.tile(next.fetch_add(1, std::memory_order_relaxed));
        if (index == tiles) return;
        const int tile = static_cast<int>(index);
        bool renders = film.tilePasses(tile) == pass &&
                       !cancelled.load(std::memory_order_relaxed) &&
                       !over.load(std::memory_order_relaxed);
        if (renders && rule.shouldStop &&
            rule.shouldStop(begun.load(std::memory_order_relaxed), 0.0))
        {
            renders = false;
            over = true;
        }
        // Not one more, however many threads come here at once.
        if (renders && begun.fetch_add(1, std::memory_order_relaxed) >= rule.newTiles)
        {
            begun.fetch_sub(1, std::memory_order_relaxed);
            renders = false;
            over = true;
        }
        if (renders) tileCounts[index] = renderTile(context, integrator, tile);
        if (renders) dirtyTiles[index] = 1;
        if (display && (dirtyTiles[index] || !display->holdsImage)) resolveTile(*display, tile);
        if (display) dirtyTiles[index] = 0;
    };
    try
    {
        workers->forEach(partial ? order.places() : tiles, renderOne);
    }
    catch (...)
    {
        addTileCounts(); // those tiles keep the pass
        throw;
    }
    addTileCounts();
    progress.newTiles = begun;
    return film.passes() > pass;
}

/// What the tiles of a pass were counted to take.
void SessionState::addTileCounts()
{
    for (TileCounts& counts : tileCounts)
    {
        progress.rays.camera += counts.cameraRays;
        progress.rays.shadow += counts.shadowRays;
        progress.rays.secondary += counts.secondaryRays;
        progress.droppedSamples += counts.droppedSamples;
        counts = TileCounts();
    }
}

RenderProgress SessionState::run(const StopRule& rule,
                                 const std::function<bool(const RenderProgress&)>& keepGoing,
                                 const DisplayTarget* display)
{
    cancelled = false;
    dirtyTiles.clear();
    progress.newTiles = 0;
    progress.photonSeconds = progress.firstPhotonSeconds = 0.0;
    if (!begin()) return progress;
    const std::unique_ptr<Integrator> integrator = newIntegrator(progress.integrator);
    const Clock::time_point start = Clock::now();
    const bool wantsError = rule.relativeError > 0.0 || static_cast<bool>(keepGoing);
    bool shown = true;
    for (int newPasses = 0; newPasses < rule.newPasses && film.passes() < rule.passes; ++newPasses)
    {
        const int pass = film.passes();
        if (progress.newTiles >= rule.newTiles) break;
        if (newPasses > 0 && secondsSince(start) >= rule.seconds) break;
        if (newPasses > 0 && rule.shouldStop &&
            rule.shouldStop(progress.newTiles, photons.secondsOf(pass)))
            break;
        const Clock::time_point passStart = Clock::now();
        PassContext context = contextOfPass(pass);
        progress.lights = sampledLightCounts(context);
        preparePhotons(context, pass);
        if (newPasses == 0) progress.firstPhotonSeconds = progress.photonSeconds;
        // In the pass that is likely to be the last one; tiles that only earlier ones of this call
        // reached are written as well.
        shown = newPasses + 1 == rule.newPasses || pass + 1 == rule.passes;
        const bool whole = renderPass(context, *integrator, rule, shown ? display : nullptr);
        progress.hitPointBytes = photons.viewBytes();
        progress.seconds += secondsSince(passStart);
        progress.passes = film.passes();
        progress.imageShare = imageShare();
        if (whole) photons.finish(filmScene, context, pass);
        if (cancelled) progress.status = {StatusCode::Cancelled, "the render was cancelled"};
        if (cancelled || !whole) break;
        if (wantsError) progress.relativeError = estimateError();
        if (rule.relativeError > 0.0 && progress.relativeError <= rule.relativeError) break;
        if (keepGoing && !keepGoing(progress)) break;
    }
    if (display && progress.newTiles > 0 && !shown) resolveRest(*display);
    return progress;
}

double SessionState::imageShare() const
{
    if (film.passes() > 0) return 1.0;
    int tiles = 0;
    for (int tile = 0; tile < film.tileCount(); ++tile)
        tiles += film.tilePasses(tile) > 0;
    return film.tileCount() > 0 ? double(tiles) / film.tileCount() : 0.0;
}

/// What no pass of this call has shown.
void SessionState::resolveRest(const DisplayTarget& display)
{
    workers->forEach(dirtyTiles.size(),
                     [&](std::size_t tile)
                     {
                         if (dirtyTiles[tile] || !display.holdsImage)
                             resolveTile(display, static_cast<int>(tile));
                     });
}

RenderSession::RenderSession(std::shared_ptr<Workers> workers,
                             std::shared_ptr<PhotonPasses> photons)
    : _state(std::make_unique<SessionState>(std::move(workers), std::move(photons)))
{
}

RenderSession::~RenderSession() = default;

void RenderSession::setScene(std::shared_ptr<const TracedScene> scene)
{
    _state->scene = std::move(scene);
}

void RenderSession::setView(const View& view)
{
    _state->view = view;
}

void RenderSession::setOptions(const RenderOptions& options)
{
    _state->options = options;
}

void RenderSession::setKeepsSurfaces(bool keeps)
{
    _state->keepsSurfaces = keeps;
}

void RenderSession::setSequence(uint32_t sequence)
{
    _state->sequence = sequence;
}

RenderProgress RenderSession::render(const StopRule& rule,
                                     const std::function<bool(const RenderProgress&)>& keepGoing,
                                     const DisplayTarget* display)
{
    try
    {
        return _state->run(rule, keepGoing, display);
    }
    catch (const EngineError& error)
    {
        return failed(_state->progress, error.code(), error.what());
    }
    catch (const std::bad_alloc&)
    {
        return failed(_state->progress, StatusCode::OutOfMemory, "out of memory");
    }
    catch (const std::exception& error)
    {
        return failed(_state->progress, StatusCode::DeviceFailure, error.what());
    }
}

void RenderSession::cancel()
{
    _state->cancelled = true;
}

void RenderSession::clear()
{
    SessionState& session = *_state;
    session.scene.reset();
    session.filmScene.reset();
    session.samples = {};
    session.hasSamples = false;
    session.surfaces = session.lastSurfaces = SurfaceMap();
    session.photons.reset(0);
    session.progress = RenderProgress();
}

int RenderSession::tilesLeft() const
{
    const Film& film = _state->film;
    const int pass = film.passes();
    int left = 0;
    for (int tile = 0; tile < film.tileCount(); ++tile)
        left += film.tilePasses(tile) == pass;
    return left;
}

const RenderProgress& RenderSession::progress() const
{
    return _state->progress;
}
int RenderSession::width() const
{
    return _state->film.width();
}
int RenderSession::height() const
{
    return _state->film.height();
}

} // namespace osgRayTrace::engine
