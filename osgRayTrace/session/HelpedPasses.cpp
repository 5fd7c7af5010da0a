// HelpedPasses.cpp - passes of a session of which others trace some tiles. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/SessionState.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/image/ChannelImage.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

namespace osgRayTrace::engine
{

/// Adds a pass of a tile that was traced elsewhere, as renderTile does.
TileCounts SessionState::takeTile(const PassContext& context, const NextPass& pass, int tile,
                                  const TracedTile& traced)
{
    TileCounts counts = traced.counts;
    const RgbaLanes* rgba = traced.rgba;
    TileRgba changed;
    if (photons.active() && traced.photons)
    {
        std::copy(rgba, rgba + kTileBlocks, changed);
        takePhotons(tile, pass.number, *traced.photons, context.options.photonAlpha, changed);
        rgba = changed;
    }
    const bool hasSurfaces = context.wantsDepth && surfaces.view.width > 0;
    for (int b = 0; hasSurfaces && b < kTileBlocks; ++b)
        setBlock(film.tileX(tile) + laneX(b, 0), film.tileY(tile) + laneY(b, 0), traced.surfaces[b],
                 surfaces);
    if (context.wantsDepth && hasSamples)
        setSurfaceSamples(traced.samples.data(), film.tileX(tile), film.tileY(tile), film.width(),
                          film.height(), samples);
    if (context.wantsDepth) std::copy(traced.depth, traced.depth + kTilePixels, film.depth(tile));
    counts.droppedSamples += static_cast<uint64_t>(film.addPass(tile, pass.number, rgba));
    return counts;
}

/// Returns what a helper's look-ups of photons in a tile begin with.
TilePhotons SessionState::tilePhotons(int tile, int pass)
{
    TilePhotons result;
    photons.begin(tile, pass, result.gathered);
    if (const SeenPlane* planes = std::exchange(result.gathered.planes, nullptr))
        result.planes.assign(planes, planes + kTilePixels);
    return result;
}

/// Takes what a helper's look-ups of photons have found in a tile, as if they had been made here.
void SessionState::takePhotons(int tile, int pass, const TilePhotons& traced, float alpha,
                               RgbaLanes* rgba)
{
    GatheredPhotons gathered;
    photons.begin(tile, pass, gathered);
    const GatheredPhotons& found = traced.gathered;
    std::copy(found.radius, found.radius + kTilePixels, gathered.radius);
    std::copy(found.count, found.count + kTilePixels, gathered.count);
    std::copy(found.flux, found.flux + kTilePixels, gathered.flux);
    gathered.carried = found.carried;
    gathered.leaked = found.leaked;
    gathered.blur = found.blur;
    gathered.blurred = found.blurred;
    std::copy(found.atFirstHits, found.atFirstHits + kTilePixels, gathered.atFirstHits);
    std::memcpy(gathered.differences, found.differences, sizeof gathered.differences);
    if (gathered.planes && gathered.choosesPlanes)
        std::copy(traced.planes.begin(), traced.planes.end(), gathered.planes);
    for (const SeenPhoton& photon : found.seen)
        if (photon.bin < photons.guideBins()) gathered.seen.push_back(photon);
    for (const SeenPoint& point : found.points)
        if (gathered.pointStride && isFinite(point.position)) gathered.points.push_back(point);
    photons.end(tile, pass, gathered, alpha, rgba);
}

/// Returns what helpers need to trace tiles of the pass.
HelpedPass SessionState::helpedPass(const PassContext& context, const NextPass& pass) const
{
    HelpedPass helped;
    helped.scene = filmScene;
    helped.view = filmView;
    helped.options = filmOptions;
    helped.options.seed = filmSeed;
    helped.pass = pass.number;
    helped.centred = filmCentred;
    helped.wantsDepth = context.wantsDepth;
    helped.wantsSurfaces = surfaces.view.width > 0;
    helped.wantsSamples = hasSamples;
    if (!photons.active()) return helped;
    helped.photons.use = context.photonUse;
    helped.photons.pass = photons.sharedPhotons();
    helped.photons.cellSize = photons.cellSize();
    helped.photons.leastRadius = context.leastPhotonRadius;
    helped.photons.largestRadius = context.largestPhotonRadius;
    return helped;
}

/// Returns whoever helps with the pass; null: nobody does. A pass that only learns is made here.
std::unique_ptr<PassHelp> SessionState::helpWith(const PassContext& context, const NextPass& pass,
                                                 const SharedTiles& tiles) const
{
    if (!help || pass.isLearning) return nullptr;
    if (progress.integrator == IntegratorKind::Ppm)
    {
        help->note("servers do not help the integrator ppm, whose passes share camera paths that "
                   "are kept here (sppm can be helped)");
        return nullptr;
    }
    if (context.volumePhotons)
    {
        help->note("servers do not help with photons in media, which are kept here");
        return nullptr;
    }
    return help->begin(helpedPass(context, pass), tiles);
}

/// Traces what helpers leave, and then what they are late with, until all tiles of the pass are
/// there. take: takes and traces a tile that nobody has; trace: traces a tile that was given away.
void SessionState::renderWithHelp(PassHelp& passHelp, std::size_t places,
                                  const std::function<void()>& takeOne,
                                  const std::function<void(int)>& trace)
{
    constexpr std::chrono::microseconds kPause(50);
    passHelp.exchange();
    workers->forEach(places,
                     [&](std::size_t)
                     {
                         takeOne();
                         passHelp.exchange();
                     });
    while (passHelp.awaited() > 0 && !cancelled.load(std::memory_order_relaxed))
    {
        passHelp.exchange();
        const std::vector<int> late = passHelp.takeLate();
        if (late.empty())
        {
            std::this_thread::sleep_for(kPause);
            continue;
        }
        workers->forEach(late.size(),
                         [&](std::size_t i)
                         {
                             if (!cancelled.load(std::memory_order_relaxed)) trace(late[i]);
                             passHelp.exchange();
                         });
    }
}

} // namespace osgRayTrace::engine
