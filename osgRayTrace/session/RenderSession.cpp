// RenderSession.cpp - the progressive image of one view. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/RenderSession.h"

#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/session/SessionState.h"

#include <new>

namespace osgRayTrace::engine
{

namespace
{

RenderProgress failed(RenderProgress& progress, StatusCode code, const char* message)
{
    progress.status = failure(code, message);
    return progress;
}

} // namespace

RenderSession::RenderSession(std::shared_ptr<Workers> workers,
                             std::shared_ptr<PhotonPasses> photons)
    : _state(std::make_unique<SessionState>(std::move(workers), std::move(photons)))
{
}

RenderSession::~RenderSession() = default;

void RenderSession::setScene(std::shared_ptr<const TracedScene> scene)
{
    const ThreadSeam::Entry inside(_state->seam);
    _state->scene = std::move(scene);
}

void RenderSession::setView(const View& view)
{
    const ThreadSeam::Entry inside(_state->seam);
    _state->view = view;
}

void RenderSession::setOptions(const RenderOptions& options)
{
    const ThreadSeam::Entry inside(_state->seam);
    _state->options = options;
}

void RenderSession::setHelp(std::shared_ptr<TileHelp> help)
{
    const ThreadSeam::Entry inside(_state->seam);
    _state->help = std::move(help);
}

void RenderSession::setKeepsSurfaces(bool keeps)
{
    const ThreadSeam::Entry inside(_state->seam);
    _state->keepsSurfaces = keeps;
}

void RenderSession::setContinuesView(bool continues)
{
    const ThreadSeam::Entry inside(_state->seam);
    _state->continuesView = continues;
}

void RenderSession::setSequence(uint32_t sequence)
{
    const ThreadSeam::Entry inside(_state->seam);
    _state->sequence = sequence;
}

void RenderSession::setCentred(bool centred)
{
    const ThreadSeam::Entry inside(_state->seam);
    _state->centred = centred;
}

void RenderSession::setSums(FilmSums kind)
{
    const ThreadSeam::Entry inside(_state->seam);
    _state->sumsKind = kind;
}

void RenderSession::setFirstPass(int pass)
{
    const ThreadSeam::Entry inside(_state->seam);
    _state->firstPass = pass;
}

void RenderSession::resume(PassSums sums)
{
    const ThreadSeam::Entry inside(_state->seam);
    OSGRAYTRACE_ASSERT(_state->sumsKind == FilmSums::Exact);
    _state->firstSums = std::move(sums);
}

std::optional<PassSums> RenderSession::passSums() const
{
    const SessionState& session = *_state;
    if (!session.filmScene || session.film.sumsKind() != FilmSums::Exact) return std::nullopt;
    const int passes = session.filmPasses.count();
    for (int tile = 0; tile < session.film.tileCount(); ++tile)
        if (session.film.tilePasses(tile) != passes) return std::nullopt;
    return sumsOf(session.film, session.filmPasses);
}

const PassSet& RenderSession::passes() const
{
    return _state->filmPasses;
}

RenderProgress RenderSession::render(const StopRule& rule,
                                     const std::function<bool(const RenderProgress&)>& keepGoing,
                                     const DisplayTarget* display)
{
    const ThreadSeam::Entry inside(_state->seam);
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
    const ThreadSeam::Entry inside(_state->seam);
    SessionState& session = *_state;
    session.scene.reset();
    session.filmScene.reset();
    session.firstSums.reset();
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

int RenderSession::tilePasses(int tile) const
{
    return _state->film.tilePasses(tile);
}

const TracedScene& RenderSession::imageScene() const
{
    return *_state->filmScene;
}

const std::vector<Light>& RenderSession::imageLights() const
{
    const SessionState& session = *_state;
    return session.placedLights.empty() ? session.filmScene->scene().lights : session.placedLights;
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
