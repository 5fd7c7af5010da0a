// RenderSessionImages.cpp - a session's image as others want it: pixels, channels. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/ExposureMeter.h"
#include "osgRayTrace/session/RenderSession.h"

#include "osgRayTrace/base/NeverDestroyed.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/Resolve.h"
#include "osgRayTrace/integrators/shared/FirstHit.h"
#include "osgRayTrace/session/SessionState.h"
#include "osgRayTrace/session/image/ChannelImage.h"
#include "osgRayTrace/session/upsample/Upsample.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

/// Returns the context of first hits of the film's view in another size; nothing without an image.
std::optional<PassContext> SessionState::contextOfSize(int width, int height) const
{
    if (!filmScene || film.passes() < 1) return std::nullopt;
    View sized = filmView;
    sized.width = width;
    sized.height = height;
    const Scene& of = filmScene->scene();
    const std::optional<CameraRays> rays = cameraRays(sized, of.origin, of.unit);
    if (!rays) return std::nullopt;
    PassContext context = contextOfPass(0);
    context.camera = *rays;
    context.width = width;
    context.height = height;
    return context;
}

ErrorEstimate SessionState::estimateError() const
{
    // Differences are of the first passes, one after the other, all made here.
    const int passes = film.passes();
    const bool whole = filmPasses == PassSet(passes) && ownPasses == passes;
    if (!whole) return engine::estimateError(film, *workers, {});
    return engine::estimateError(film, *workers, photons.discDifferences(),
                                 photons.footprintBiases(passes, *workers));
}

/// Writes the image to the display. If over is true, tiles without a pass are left as they are.
void SessionState::resolve(const DisplayTarget& display, bool over) const
{
    workers->forEach(static_cast<std::size_t>(film.tileCount()),
                     [&](std::size_t index)
                     {
                         const int tile = static_cast<int>(index);
                         if (!over || film.tilePasses(tile) > 0) resolveTile(display, tile);
                     });
}

void SessionState::resolveTile(const DisplayTarget& display, int tile) const
{
    resolveTileDisplay(film, tile, display.toneMap, display.rgba, display.depth);
    if (!display.changed) return;
    display.changed->color[static_cast<std::size_t>(tile)] = 1;
    if (display.depth) display.changed->depth[static_cast<std::size_t>(tile)] = 1;
}

ErrorEstimate RenderSession::estimateError() const
{
    return _state->estimateError();
}

std::optional<float> RenderSession::meteredEv(int mostTiles) const
{
    const bool displayReferred = _state->filmScene && _state->filmScene->scene().displayReferred;
    return engine::meteredEv(_state->film, displayReferred, mostTiles);
}

std::vector<float> RenderSession::resolveRadiance() const
{
    std::vector<float> image(4 * static_cast<std::size_t>(width()) *
                             static_cast<std::size_t>(height()));
    resolveRows(image.data(), nullptr, [](std::size_t, std::size_t) {});
    return image;
}

void RenderSession::resolveRows(float* radiance, float* depth,
                                const std::function<void(std::size_t, std::size_t)>& take) const
{
    const Film& film = _state->film;
    const bool displayReferred = _state->filmScene && _state->filmScene->scene().displayReferred;
    const int across = (film.width() + kTileSize - 1) / kTileSize;
    if (across == 0) return;
    _state->workers->forEach(
        static_cast<std::size_t>(film.tileCount() / across),
        [&](std::size_t row)
        {
            const int first = static_cast<int>(row) * across;
            for (int tile = first; tile < first + across; ++tile)
            {
                resolveTileRadiance(film, tile, displayReferred, radiance);
                if (depth) resolveTileDepth(film, tile, depth);
            }
            const std::size_t bottom = row * kTileSize;
            take(bottom, std::min(bottom + kTileSize, static_cast<std::size_t>(film.height())));
        });
}

void RenderSession::resolveDisplay(const ToneMap& toneMap, uint8_t* rgba, float* depth) const
{
    _state->resolve({toneMap, rgba, depth}, false);
}

void RenderSession::resolveOver(const ToneMap& toneMap, uint8_t* rgba, float* depth) const
{
    _state->resolve({toneMap, rgba, depth}, true);
}

std::vector<float> RenderSession::resolveChannel(Channel channel) const
{
    const SessionState& session = *_state;
    if (!session.filmScene) return {}; // there was never an image either
    return channelImage(channel, session.film, session.contextOfPass(0), *session.workers);
}

ResolvedImage RenderSession::resolvedImage() const
{
    const SessionState& session = *_state;
    ResolvedImage image;
    if (!session.filmScene || !session.hasAllDepths()) return image;
    image.width = width();
    image.height = height();
    image.radiance = resolveRadiance();
    image.depth = resolveChannel(Channel::Depth);
    if (session.film.passes() > 1) image.error = resolveChannel(Channel::Error);
    return image;
}

const std::vector<SurfaceSample>& RenderSession::surfaceSamples() const
{
    static const NeverDestroyed<std::vector<SurfaceSample>> kNone;
    SessionState& session = *_state;
    const bool hasImage = session.filmScene && session.hasAllDepths();
    if (!hasImage) return *kNone;
    if (!session.hasSamples)
        engine::surfaceSamples(session.contextOfPass(0), *session.workers, session.samples);
    session.hasSamples = true;
    return session.samples;
}

/// Completes the surfaces of the image. The first pass's samples are anywhere in their pixels. The
/// surface in the middle of a pixel decides what the pixel is taken for, so that a pixel at an edge
/// does not change sides from frame to frame.
void SessionState::finishSurfaces()
{
    SurfaceMap& map = surfaces;
    if (map.finished || map.view.width == 0 || film.passes() < 1) return;
    findSmooth(*workers, map);
    if (!filmOptions.centredFirstPass)
    {
        const PassContext context = contextOfPass(0);
        constexpr int kRow = kTileSize * kTileSize; // pixels of a row that are looked at together
        const int across = (map.view.width + kRow - 1) / kRow;
        const int down = (map.view.height + kBlockSize - 1) / kBlockSize;
        workers->forEach(static_cast<std::size_t>(across) * static_cast<std::size_t>(down),
                         [&](std::size_t index)
                         {
                             const int first = static_cast<int>(index) % across * kRow;
                             const int bottom = static_cast<int>(index) / across * kBlockSize;
                             const int end = std::min(first + kRow, map.view.width);
                             for (int left = first; left < end; left += kBlockSize)
                             {
                                 if (isSmooth(map, left, bottom)) continue;
                                 SurfaceBlock seen;
                                 firstSurfaces(context, left, bottom, 0, seen);
                                 setBlock(left, bottom, seen, map);
                             }
                         });
        findSmooth(*workers, map);
    }
    findInteriors(*workers, map);
    map.finished = true;
}

const SurfaceMap& RenderSession::surfaces()
{
    _state->finishSurfaces();
    return _state->surfaces;
}

/// Finds the surfaces in the middles of all pixels of the film's view.
void SessionState::findSurfaces()
{
    if (!beginSurfaceMap(filmView, surfaces)) return;
    const PassContext context = contextOfPass(0);
    const int across = (filmView.width + kBlockSize - 1) / kBlockSize;
    const int down = (filmView.height + kBlockSize - 1) / kBlockSize;
    workers->forEach(static_cast<std::size_t>(down),
                     [&](std::size_t row)
                     {
                         const int bottom = static_cast<int>(row) * kBlockSize;
                         for (int column = 0; column < across; ++column)
                         {
                             SurfaceBlock seen;
                             firstSurfaces(context, column * kBlockSize, bottom, 0, seen);
                             setBlock(column * kBlockSize, bottom, seen, surfaces);
                         }
                     });
}

const SurfaceMap& RenderSession::firstSurfaces()
{
    if (!_state->surfaces.isOf(_state->filmView)) _state->findSurfaces();
    return _state->surfaces;
}

void RenderSession::findMiddles(const std::vector<std::pair<int, int>>& blocks)
{
    const PassContext context = _state->contextOfPass(0);
    _state->workers->forEach(blocks.size(),
                             [&](std::size_t i)
                             {
                                 const auto [left, bottom] = blocks[i];
                                 SurfaceBlock seen;
                                 engine::firstSurfaces(context, left, bottom, 0, seen);
                                 setBlock(left, bottom, seen, _state->surfaces);
                             });
}

const SurfaceMap& RenderSession::lastSurfaces() const
{
    return _state->lastSurfaces;
}

UpsampleCounts RenderSession::upsample(const ResolvedImage& image,
                                       const std::vector<SurfaceSample>& samples, int width,
                                       int height, ResolvedImage& result, double mostTraced) const
{
    const std::optional<PassContext> full = _state->contextOfSize(width, height);
    if (full) return engine::upsample(image, samples, *full, mostTraced, *_state->workers, result);
    result = ResolvedImage();
    return {};
}

UpsampleCounts RenderSession::presentUpsampled(const ResolvedImage& image,
                                               const std::vector<SurfaceSample>& samples, int width,
                                               int height, const DisplayTarget& display,
                                               double mostTraced) const
{
    const std::optional<PassContext> full = _state->contextOfSize(width, height);
    if (!full) return {};
    return engine::presentUpsampled(image, samples, *full, mostTraced, display.toneMap,
                                    *_state->workers, display.rgba, display.depth);
}

} // namespace osgRayTrace::engine
