// SessionPasses.cpp - how passes are added to the image of a session. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/SessionState.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/TileOrder.h"
#include "osgRayTrace/integrators/IntegratorFactory.h"
#include "osgRayTrace/integrators/shared/SurfaceSample.h"
#include "osgRayTrace/session/image/ChannelImage.h"

#include <algorithm>
#include <chrono>

namespace osgRayTrace::engine
{

namespace
{

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin)
{
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Lets tiles of a pass begin until the rule ends it.
struct TileGate
{
    const StopRule& rule;
    std::atomic<int> begun;
    std::atomic<bool> over{false};

    /// Returns whether one more tile may begin, and counts it.
    bool begins()
    {
        if (over.load(std::memory_order_relaxed)) return false;
        if (rule.shouldStop && rule.shouldStop(begun.load(std::memory_order_relaxed), 0.0))
        {
            over = true;
            return false;
        }
        // No more tiles are begun than the rule allows, however many threads come here at once.
        if (begun.fetch_add(1, std::memory_order_relaxed) < rule.newTiles) return true;
        begun.fetch_sub(1, std::memory_order_relaxed);
        over = true;
        return false;
    }
};

} // namespace

/// Adds a pass of a tile, in the film itself if that is possible.
TileCounts SessionState::renderTile(const PassContext& context, const Integrator& integrator,
                                    const NextPass& pass, int tile)
{
    TileRgba local;
    TileResult result;
    RgbaLanes* inFilm = pass.isLearning ? nullptr : film.firstPassStorage(tile, pass.number);
    result.rgba = inFilm ? inFilm : local;
    GatheredPhotons gathered;
    if (photons.active())
    {
        photons.begin(tile, pass.number, gathered);
        result.photons.gathered = &gathered;
        result.photons.hitPoints = photons.hitPoints(tile, pass.number);
    }
    SurfaceBlock firstHits[kTileBlocks];
    const bool keeps = context.wantsDepth && surfaces.view.width > 0;
    if (keeps) result.firstHits.surfaces = firstHits;
    const bool keepsSamples = context.wantsDepth && hasSamples;
    const std::unique_ptr<SurfaceSample[]> seen(keepsSamples ? new SurfaceSample[kTilePixels]
                                                             : nullptr);
    result.firstHits.samples = seen.get();
    integrator.renderTile(context, film.tileX(tile), film.tileY(tile), result);
    for (int b = 0; keeps && b < kTileBlocks; ++b)
        setBlock(film.tileX(tile) + laneX(b, 0), film.tileY(tile) + laneY(b, 0), firstHits[b],
                 surfaces);
    if (keepsSamples)
        setSurfaceSamples(seen.get(), film.tileX(tile), film.tileY(tile), film.width(),
                          film.height(), samples);
    if (photons.active())
        photons.end(tile, pass.number, gathered, context.options.photonAlpha, result.rgba);
    if (context.wantsDepth)
        std::copy(result.firstHits.depth, result.firstHits.depth + kTilePixels, film.depth(tile));
    if (pass.isLearning) return result.counts;
    if (inFilm)
        film.finishPass(tile, pass.number);
    else
        result.counts.droppedSamples +=
            static_cast<uint64_t>(film.addPass(tile, pass.number, local));
    return result.counts;
}

/// Gets the photons of a pass, which may be one that an earlier call did not finish.
void SessionState::preparePhotons(PassContext& context, int pass)
{
    const Clock::time_point start = Clock::now();
    photons.prepare(filmScene, context, pass, *workers);
    progress.photonSeconds += secondsSince(start);
    progress.photonNote = photons.note();
    const PhotonPass* traced = photons.photons();
    progress.photonRadius =
        traced ? static_cast<float>(photons.radius() * filmScene->scene().unit) : 0.0f;
    progress.storedPhotons = traced ? traced->map.size() : 0;
    progress.storedBeams = traced ? traced->volume.beams.size() : 0;
    progress.storedPoints = traced ? traced->volume.points.size() : 0;
    progress.beamRadius = static_cast<float>(
        progress.storedBeams ? double(context.beamRadius) * filmScene->scene().unit : 0.0);
    progress.photonBytes = photons.keptBytes();
    if (!traced) return;
    if (pass < photonsCounted) return;
    progress.rays.photon += traced->rays;
    progress.droppedSamples += traced->dropped;
    progress.cutWalks += traced->cutWalks;
    progress.openWalks += traced->openWalks;
    photonsCounted = pass + 1;
}

/// Returns all tiles: those with a mark, then those that had no pass for the longest time.
std::vector<std::size_t> SessionState::firstPassOrder(const TileOrder& order,
                                                      const std::vector<uint8_t>& firstTiles) const
{
    const auto tiles = static_cast<std::size_t>(film.tileCount());
    std::vector<std::size_t> queue;
    queue.reserve(tiles);
    for (std::size_t place = 0; place < order.places(); ++place)
        if (order.tile(place) < tiles) queue.push_back(order.tile(place));
    const auto urgency = [&](std::size_t tile)
    { return firstTiles[tile] ? 0x10000 : static_cast<int>(tileAges[tile]); };
    std::stable_sort(queue.begin(), queue.end(),
                     [&](std::size_t a, std::size_t b) { return urgency(a) > urgency(b); });
    return queue;
}

/// Adds one pass to every tile that does not have it yet, and shows the pass. Returns false if some
/// tiles still lack the pass.
bool SessionState::renderPass(const PassContext& context, const Integrator& integrator,
                              const NextPass& pass, const StopRule& rule,
                              const DisplayTarget* display)
{
    const int before = film.passes();
    const auto tiles = static_cast<std::size_t>(film.tileCount());
    const TileOrder order(static_cast<std::size_t>(tilesAlong(film.width())),
                          static_cast<std::size_t>(tilesAlong(film.height())),
                          static_cast<std::size_t>(rule.groupedTiles));
    std::atomic<std::size_t> next{0};
    TileGate gate{rule, {progress.newTiles}};
    tileCounts.assign(tiles, TileCounts());
    dirtyTiles.resize(tiles);
    film.beginPass();
    if (pass.isLearning) learntPasses.resize(tiles, 0);
    const bool partial = rule.shouldStop || rule.newTiles < std::numeric_limits<int>::max();
    const std::vector<std::size_t> queue = partial && before == 0 && rule.firstTiles
                                               ? firstPassOrder(order, *rule.firstTiles)
                                               : std::vector<std::size_t>();
    const std::size_t places = partial && queue.empty() ? order.places() : tiles;
    // Workers begin at several places at once; all of them together have to keep an order.
    const auto nextInOrder = [&]
    {
        const std::size_t place = next.fetch_add(1, std::memory_order_relaxed);
        if (!queue.empty()) return place < tiles ? queue[place] : tiles;
        if (!partial) return std::min(place, tiles);
        return place < order.places() ? order.tile(place) : tiles;
    };
    const auto begins = [&](std::size_t index)
    {
        const int tile = static_cast<int>(index);
        const bool lacksPass =
            pass.isLearning ? learntPasses[index] <= pass.number : film.tilePasses(tile) == before;
        return lacksPass && !cancelled.load(std::memory_order_relaxed) && gate.begins();
    };
    const auto show = [&](std::size_t index)
    {
        if (display && (dirtyTiles[index] || !display->holdsImage))
            resolveTile(*display, static_cast<int>(index));
        if (display) dirtyTiles[index] = 0;
    };
    const auto renderBegun = [&](std::size_t index)
    {
        tileCounts[index] = renderTile(context, integrator, pass, static_cast<int>(index));
        if (pass.isLearning)
            learntPasses[index] = pass.number + 1;
        else
            dirtyTiles[index] = 1;
    };
    const auto renderOne = [&](std::size_t index)
    {
        if (partial) index = nextInOrder();
        if (index == tiles) return;
        if (begins(index)) renderBegun(index);
        show(index);
    };
    SharedTiles shared;
    shared.take = [&]
    {
        while (true)
        {
            const std::size_t index = nextInOrder();
            if (next.load(std::memory_order_relaxed) > places && index == tiles) return -1;
            if (index == tiles) continue; // a place without a tile
            if (begins(index)) return static_cast<int>(index);
            show(index);
        }
    };
    shared.bring = [&](int tile, const TracedTile& traced)
    {
        const auto index = static_cast<std::size_t>(tile);
        tileCounts[index] = takeTile(context, pass, tile, traced);
        dirtyTiles[index] = 1;
        show(index);
    };
    shared.left = [&]
    {
        const std::size_t taken = next.load(std::memory_order_relaxed);
        return gate.over.load(std::memory_order_relaxed) || taken >= places
                   ? 0
                   : static_cast<int>(places - taken);
    };
    shared.photonsOf = [&](int tile) { return tilePhotons(tile, pass.number); };
    const std::unique_ptr<PassHelp> passHelp = helpWith(context, pass, shared);
    try
    {
        if (!passHelp)
            workers->forEach(places, renderOne);
        else
            renderWithHelp(
                *passHelp, places,
                [&]
                {
                    const std::size_t index = nextInOrder();
                    if (index == tiles) return;
                    if (begins(index)) renderBegun(index);
                    show(index);
                },
                [&](int tile)
                {
                    renderBegun(static_cast<std::size_t>(tile));
                    show(static_cast<std::size_t>(tile));
                });
    }
    catch (...)
    {
        addTileCounts(); // the tiles that were rendered keep the pass
        throw;
    }
    addTileCounts();
    progress.newTiles = gate.begun;
    if (!pass.isLearning) return film.passes() > before;
    return std::all_of(learntPasses.begin(), learntPasses.end(),
                       [&](int learnt) { return learnt > pass.number; });
}

/// Returns the next pass that the film is to get; nothing if it is to get no more.
std::optional<int> SessionState::askForPass(const StopRule& rule) const
{
    const int pass = rule.nextPass ? rule.nextPass() : filmPasses.firstMissing(filmFirstPass);
    const bool isWanted =
        rule.nextPass ? pass >= 0 && !filmPasses.contains(pass) : pass < rule.passes;
    return isWanted ? std::optional<int>(pass) : std::nullopt;
}

/// Returns the pass to make next: the wanted one, or one that it depends on.
SessionState::NextPass SessionState::nextPass() const
{
    const bool learns = tracedPasses < photons.sharedPasses() && tracedPasses < *wantedPass;
    return {learns ? tracedPasses : *wantedPass, learns};
}

/// Forgets what the first passes have taught, for one of them that was only learnt from and is now
/// wanted for the film: it would teach what it has taught again. All of it will be the same.
void SessionState::learnAnew()
{
    photons.reset(film.tileCount());
    photons.choose(filmScene, contextOfPass(0), *workers);
    tracedPasses = 0;
    learntPasses.clear();
}

/// Records that all tiles have had a pass. passes: those that the film has now.
void SessionState::finishPass(const PassContext& context, const NextPass& pass, PassSet&& passes)
{
    filmPasses = std::move(passes);
    if (pass.number == tracedPasses) ++tracedPasses;
    if (!pass.isLearning) ++ownPasses;
    if (!pass.isLearning) wantedPass.reset();
    photons.finish(filmScene, context, pass.number);
}

/// Adds the counts of the tiles of a pass to the progress.
void SessionState::addTileCounts()
{
    for (TileCounts& counts : tileCounts)
    {
        progress.rays.camera += counts.cameraRays;
        progress.rays.shadow += counts.shadowRays;
        progress.rays.secondary += counts.secondaryRays;
        progress.droppedSamples += counts.droppedSamples;
        progress.collisions += counts.collisions;
        progress.cutWalks += counts.cutWalks;
        progress.openWalks += counts.openWalks;
        counts = TileCounts();
    }
}

namespace
{

/// Returns whether the error of the image is to be estimated anew. An estimate reads all of the
/// film, which is a sixth of a short pass: if it ends nothing, the one of 4 / 5 of the passes will
/// do. That depends on passes alone, so that a caller who ends by it ends at the same pass again.
bool estimateIsDue(const StopRule& rule, int passes, int estimated)
{
    return rule.relativeError > 0.0 || passes - estimated >= std::max(1, estimated / 4);
}

} // namespace

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
    const bool wantsError = rule.relativeError > 0.0 || (keepGoing && !rule.nextPass);
    bool shown = true;
    progress.passes = film.passes();
    progress.imageShare = imageShare();
    if (filmFirstPass > 0 || progress.passes > 0 || rule.nextPass || rule.pose)
        photons.choose(filmScene, contextOfPass(0), *workers);
    int added = 0;     // passes that the film has got from this call
    int estimated = 0; // passes of the film that progress.error is of
    for (int newPasses = 0; newPasses < rule.newPasses; ++newPasses)
    {
        if (!wantedPass || !rule.nextPass) wantedPass = askForPass(rule);
        if (!wantedPass) break;
        if (*wantedPass < std::min(tracedPasses, photons.sharedPasses())) learnAnew();
        const NextPass next = nextPass();
        const int pass = next.number;
        if (progress.newTiles >= rule.newTiles) break;
        if (added > 0 && secondsSince(start) >= rule.seconds) break;
        if (newPasses > 0 && rule.shouldStop &&
            rule.shouldStop(progress.newTiles, photons.secondsOf(pass)))
            break;
        const Clock::time_point passStart = Clock::now();
        takePose(rule, pass);
        PassContext context = contextOf(next);
        progress.lights = sampledLightCounts(context);
        preparePhotons(context, pass);
        preparePortals(context, pass);
        if (newPasses == 0) progress.firstPhotonSeconds = progress.photonSeconds;
        // The display is written in the pass that is likely to be the last one, with the tiles that
        // only earlier passes of this call reached.
        shown = newPasses + 1 == rule.newPasses || pass + 1 == rule.passes;
        // Memory comes first: the film has the pass once its tiles do.
        PassSet passesAfter = filmPasses;
        if (!next.isLearning) passesAfter.add(pass);
        const bool whole = renderPass(context, *integrator, next, rule, shown ? display : nullptr);
        progress.hitPointBytes = photons.viewBytes();
        progress.seconds += secondsSince(passStart);
        progress.passes = film.passes();
        progress.imageShare = imageShare();
        if (whole) finishPass(context, next, std::move(passesAfter));
        if (whole && !next.isLearning) ++added;
        if (cancelled) progress.status = {StatusCode::Cancelled, "the render was cancelled"};
        if (cancelled || !whole) break;
        if (wantsError && estimateIsDue(rule, progress.passes, estimated))
        {
            progress.error = estimateError();
            estimated = progress.passes;
        }
        if (rule.relativeError > 0.0 && progress.error.relative <= rule.relativeError) break;
        if (keepGoing && !keepGoing(progress)) break;
    }
    if (wantsError && added > 0 && estimated != progress.passes) progress.error = estimateError();
    if (display && progress.newTiles > 0 && !shown) resolveRest(*display);
    // The depths of the image are those of its least pass, and so is all that is seen in it.
    if (!filmPasses.empty()) takePose(rule, filmPasses.ranges().front().first);
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

/// Writes the tiles that no pass of this call has written to the display.
void SessionState::resolveRest(const DisplayTarget& display)
{
    workers->forEach(dirtyTiles.size(),
                     [&](std::size_t tile)
                     {
                         if (dirtyTiles[tile] || !display.holdsImage)
                             resolveTile(display, static_cast<int>(tile));
                     });
}

} // namespace osgRayTrace::engine
