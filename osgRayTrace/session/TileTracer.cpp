// TileTracer.cpp - traces tiles of passes of others' images. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/TileTracer.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/integrators/IntegratorFactory.h"
#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/session/SessionState.h"

#include <utility>

namespace osgRayTrace::engine
{

TileTracer::TileTracer(std::shared_ptr<Workers> workers)
    : _workers(std::move(workers)), _state(std::make_unique<SessionState>(_workers, nullptr))
{
}

TileTracer::~TileTracer() = default;

bool TileTracer::begin(const HelpedPass& pass)
{
    _pass = pass;
    _integrator.reset();
    SessionState& state = *_state;
    const bool same = state.filmScene && state.filmScene == pass.scene &&
                      state.filmView == pass.view && state.filmCentred == pass.centred &&
                      !pass.options.needsRestart(state.filmOptions);
    state.scene = pass.scene;
    state.view = pass.view;
    state.options = pass.options;
    state.centred = pass.centred;
    if (!same && !state.beginView()) return false;
    _context = std::make_unique<PassContext>(state.contextOfPass(pass.pass));
    _context->wantsDepth = pass.wantsDepth;
    _context->photonUse = PhotonUse::None;
    if (pass.photons.pass)
    {
        _projection = PixelProjection(_context->camera);
        _context->photonUse = pass.photons.use;
        _context->photons = &pass.photons.pass->map;
        _context->projection = &_projection;
        _context->leastPhotonRadius = pass.photons.leastRadius;
        _context->largestPhotonRadius = pass.photons.largestRadius;
    }
    state.preparePortals(*_context, pass.pass);
    _integrator = newIntegrator(state.progress.integrator);
    return true;
}

int TileTracer::tileCount() const
{
    return tilesAlong(_pass.view.width) * tilesAlong(_pass.view.height);
}

void TileTracer::trace(const std::vector<int>& tiles, std::vector<TilePhotons>&& photons,
                       std::vector<TracedTile>& results)
{
    results.resize(tiles.size());
    const int across = tilesAlong(_pass.view.width);
    _workers->forEach(tiles.size(),
                      [&](std::size_t i)
                      {
                          TracedTile& traced = results[i];
                          TileResult result;
                          result.rgba = traced.rgba;
                          if (_pass.wantsDepth && _pass.wantsSurfaces)
                              result.firstHits.surfaces = traced.surfaces;
                          traced.samples.resize(_pass.wantsDepth && _pass.wantsSamples
                                                    ? std::size_t(kTilePixels)
                                                    : 0);
                          if (!traced.samples.empty())
                              result.firstHits.samples = traced.samples.data();
                          if (_pass.photons.pass)
                          {
                              traced.photons = std::make_unique<TilePhotons>(std::move(photons[i]));
                              result.photons.gathered = &traced.photons->gathered;
                              if (!traced.photons->planes.empty())
                                  traced.photons->gathered.planes = traced.photons->planes.data();
                          }
                          _integrator->renderTile(*_context, tiles[i] % across * kTileSize,
                                                  tiles[i] / across * kTileSize, result);
                          traced.counts = result.counts;
                          if (_pass.wantsDepth)
                              std::copy(result.firstHits.depth,
                                        result.firstHits.depth + kTilePixels, traced.depth);
                      });
}

void TileTracer::clear()
{
    _pass = HelpedPass();
    _context.reset();
    _integrator.reset();
    _state->scene.reset();
    _state->filmScene.reset();
}

} // namespace osgRayTrace::engine
