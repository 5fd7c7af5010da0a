// SessionSamples.cpp - samples of single pixels beside those of the film. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/Resolve.h"
#include "osgRayTrace/integrators/IntegratorFactory.h"
#include "osgRayTrace/integrators/shared/IntegratorChoice.h"
#include "osgRayTrace/session/RenderSession.h"
#include "osgRayTrace/session/SessionState.h"
#include "osgRayTrace/session/TileSamples.h"

#include <algorithm>
#include <atomic>
#include <iterator>

namespace osgRayTrace::engine
{

namespace
{

/// Tells the random numbers of further samples from those of the film's sequences.
constexpr uint32_t kFurtherSeed = 0x9e3779b9u;

/// Sets the lanes of the pixels that want more than so many samples. Returns whether any do.
bool findWanted(const TileSamples& tile, int samples, LaneMask* wanted)
{
    LaneMask any = 0;
    for (int b = 0; b < kTileBlocks; ++b)
    {
        wanted[b] = 0;
        for (int i = 0; i < kLanes; ++i)
            wanted[b] |= static_cast<LaneMask>(tile.wanted[b * kLanes + i] > samples) << i;
        any |= wanted[b];
    }
    return any != 0;
}

/// Adds a sample of each wanted pixel to the sums, which mean holds until all are there.
void addSample(const TileRgba& sample, const LaneMask* wanted, TileSamples& tile)
{
    for (int b = 0; b < kTileBlocks; ++b)
        for (const int i : lanesIn(wanted[b]))
        {
            RgbaLanes& sum = tile.mean[b];
            sum.r[i] += sample[b].r[i];
            sum.g[i] += sample[b].g[i];
            sum.b[i] += sample[b].b[i];
            sum.a[i] += sample[b].a[i];
            ++tile.count[b * kLanes + i];
        }
}

void divideByCount(TileSamples& tile)
{
    for (int b = 0; b < kTileBlocks; ++b)
        for (int i = 0; i < kLanes; ++i)
        {
            const int count = tile.count[b * kLanes + i];
            const float scale = count > 0 ? 1.0f / static_cast<float>(count) : 0.0f;
            RgbaLanes& mean = tile.mean[b];
            mean.r[i] *= scale;
            mean.g[i] *= scale;
            mean.b[i] *= scale;
            mean.a[i] *= scale;
        }
}

} // namespace

/// Makes one sample more, which is the one of that number, of each pixel of the tile that wants it.
TileCounts SessionState::sampleTile(const PassContext& context, const Integrator& integrator,
                                    int number, TileSamples& tile) const
{
    LaneMask wanted[kTileBlocks];
    if (!findWanted(tile, number, wanted)) return {};
    TileRgba sample = {};
    TileResult result;
    result.rgba = sample;
    result.wanted = wanted;
    integrator.renderTile(context, film.tileX(tile.tile), film.tileY(tile.tile), result);
    addSample(sample, wanted, tile);
    return result.counts;
}

void SessionState::samplePixels(std::vector<TileSamples>& tiles,
                                const std::function<bool()>& shouldStop)
{
    const std::unique_ptr<Integrator> integrator = newIntegrator(progress.integrator);
    int most = 0;
    for (const TileSamples& tile : tiles)
        most = std::max<int>(most, *std::max_element(tile.wanted, std::end(tile.wanted)));
    std::atomic<bool> stopped{false};
    for (int number = 0; number < most && !stopped; ++number)
    {
        PassContext context = contextOfPass(number);
        context.key = context.pathKey = passKey(hash(filmSeed, kFurtherSeed), number);
        context.wantsDepth = false;
        context.throughCentres = filmCentred;
        tileCounts.assign(tiles.size(), TileCounts());
        workers->forEach(tiles.size(),
                         [&](std::size_t i)
                         {
                             if (stopped || shouldStop())
                                 stopped = true;
                             else
                                 tileCounts[i] = sampleTile(context, *integrator, number, tiles[i]);
                         });
        addTileCounts();
    }
    const bool displayReferred = filmScene->scene().displayReferred;
    for (TileSamples& tile : tiles)
    {
        divideByCount(tile);
        if (displayReferred) decode(tile.mean);
    }
}

void RenderSession::samplePixels(std::vector<TileSamples>& tiles,
                                 const std::function<bool()>& shouldStop)
{
    const ThreadSeam::Entry inside(_state->seam);
    OSGRAYTRACE_ASSERT(photonUse(_state->progress.integrator) == PhotonUse::None);
    _state->samplePixels(tiles, shouldStop);
}

} // namespace osgRayTrace::engine
