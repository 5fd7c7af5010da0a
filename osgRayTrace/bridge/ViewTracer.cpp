// ViewTracer.cpp - the accumulated image of one view, frame after frame. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/ViewTracer.h"

#include "osgRayTrace/bridge/RenderOptionsFromSettings.h"
#include "osgRayTrace/film/Enlarge.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Still frames before full resolution is begun: a hand that moves the view does not do so in every
/// frame.
constexpr int kSettling = 2;

/// Share of a frame that is traced in even if all that comes after it takes longer than the budget.
constexpr double kLeastShare = 0.2;

/// What upsampling takes of one thread for a pixel, until it is known [s].
constexpr double kUpsampleSeconds = 12e-9;

double steadySeconds()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// OSG's culling clamps the planes of last frame's projection matrix again, so that the third
/// column of a view at rest wanders by its last digits; an image must go on nevertheless.
bool sameButForRounding(const View& a, const View& b)
{
    constexpr double kTolerance = 1e-9;
    View rounded = a;
    for (int i = 0; i < 4; ++i)
    {
        double& depth = rounded.clipFromView[i][2];
        const double other = b.clipFromView[i][2];
        if (std::abs(depth - other) <= kTolerance * std::abs(other)) depth = other;
    }
    return rounded == b;
}

double pixelsOf(const View& view) { return double(view.width) * view.height; }

bool same(const ToneMap& a, const ToneMap& b)
{
    return a.exposureEv == b.exposureEv && a.displayReferred == b.displayReferred;
}

/// The same view in fewer pixels.
View reducedView(View view, int divider)
{
    view.width = reducedSize(view.width, divider);
    view.height = reducedSize(view.height, divider);
    return view;
}

} // namespace

ViewTracer::ViewTracer(std::function<double()> now) : _now(now ? std::move(now) : steadySeconds) {}

/// True if the image of the last frame is not the one that is wanted now.
bool ViewTracer::takeInputs(const SceneVersion& version, const View& pass)
{
    bool moved = false;
    if (_workers != version.workers)
    {
        _workers = version.workers;
        _session = std::make_unique<RenderSession>(version.workers, version.photons);
        _reduced = std::make_unique<RenderSession>(version.workers, version.photons);
        _upsampleSeconds = kUpsampleSeconds / _workers->threads();
        _surfacesOf = nullptr;
        _imageOf = nullptr;
        _history.drop();
        _shown = Shown::Whole;
        moved = true;
    }
    if (version.scene != _scene)
    {
        // What is not shown would only keep the last version of the scene from being changed in
        // place.
        (_shown == Shown::Whole ? _reduced : _session)->clear();
        if (_shown == Shown::Mixed) _shown = Shown::Reduced;
        _scene = version.scene;
        moved = true;
    }
    const RenderOptions options = renderOptionsFromSettings(*version.settings);
    moved |= options.needsRestart(_options);
    _options = options;
    if (!sameButForRounding(pass, _view))
    {
        _view = pass;
        moved = true;
    }
    _maxPasses = version.settings->getMaxPasses();
    _reprojects = version.settings->getReproject();
    return moved;
}

bool ViewTracer::trace(const SceneVersion& version, const View& pass, const FrameBudget& budget,
                       uint8_t* rgba, float* depth)
{
    _begin = _now();
    const bool moved = takeInputs(version, pass);
    _stillFrames = moved ? 0 : _stillFrames + 1;
    _denoises = denoises(*version.settings);
    if (_denoises) rgba = nullptr; // that takes the whole image: resolve() does it
    _holdsFull = _holdsFull && rgba;
    _display = {toneMapFromSettings(*version.settings, version.scene->scene()), rgba, depth};
    _written = false;
    _frame.traceSeconds = 0.0;
    _newTiles = 0;

    if (!(budget.seconds > 0.0))
    {
        traceFixed(version.settings->getPassesPerFrame());
    }
    else
    {
        FrameSituation frame;
        frame.width = _view.width;
        frame.height = _view.height;
        frame.moved = moved;
        frame.degrade = budget.degrade;
        setDeadline(budget.seconds, moved);
        frame.seconds = secondsLeft();
        if (moved)
            traceMoved(frame);
        else
            traceStill(frame);
    }
    _upsamples = budget.seconds > 0.0 &&
                 _upsampleSeconds * pixelsOf(_view) <= budget.upsampleShare * budget.seconds;
    _showing = _shown == Shown::Reduced                  ? Showing::Reduced
               : _shown == Shown::Mixed && _imageChanged ? Showing::FirstMixed
                                                         : Showing::Whole;
    _traceEnd = _now();
    return _written;
}

/// What comes after tracing will take as long as it did.
void ViewTracer::setDeadline(double budget, bool moved)
{
    const bool reduced = _shown == Shown::Reduced && (moved || _stillFrames < kSettling);
    const Showing showing = reduced                    ? Showing::Reduced
                            : _shown == Shown::Reduced ? Showing::FirstMixed
                                                       : Showing::Whole;
    double& after = _afterSeconds[static_cast<int>(showing)];
    const double pixels = pixelsOf(_view);
    if (after == 0.0 && showing != Showing::Reduced) after = pixels * 2e-9; // a guess
    double seconds = budget - after;
    // Each thread ends the tile that it is at.
    seconds -= _planner.tileSeconds(reduced ? 2 : 1) * _workers->threads();
    const int passes = _session->progress().passes;
    if (!moved && passes + 1 >= _nextEstimate) seconds -= _estimateSeconds;
    _deadline = std::max(seconds, kLeastShare * budget);
}

void ViewTracer::traceFixed(int passes)
{
    StopRule rule;
    rule.newPasses = passes;
    const bool continues = _shown == Shown::Whole;
    const RenderProgress made = render(*_session, 1, rule, &_display);
    if (!made.status.ok() || made.passes < 1) return;
    _shown = Shown::Whole;
    _imageChanged |= !continues && made.newTiles == 0;
    if (made.newTiles > 0) estimateError();
}

/// Time for one whole pass, at any resolution, must be.
void ViewTracer::traceMoved(FrameSituation frame)
{
    const bool guessed = frame.degrade && !_planner.knowsCosts();
    FramePlan plan = _planner.plan(frame);
    bool traced = traceImage(plan, frame, frame.degrade);
    if (!traced && _status.ok())
    {
        frame.seconds = secondsLeft();
        plan = _planner.replan(frame);
        traced = traceImage(plan, frame, false);
    }
    if (!traced || !guessed) return;
    frame.seconds = secondsLeft();
    const FramePlan finer = _planner.replan(frame);
    if (finer.divider <= plan.divider / 2) traceImage(finer, frame, false);
}

/// A whole pass of a new image, and what more there is time for. False if it was given up, or
/// failed.
bool ViewTracer::traceImage(const FramePlan& plan, const FrameSituation& frame, bool mayGiveUp)
{
    const bool reduced = plan.divider > 1;
    const int whole =
        tilesOf(reducedSize(_view.width, plan.divider), reducedSize(_view.height, plan.divider));
    const double start = _now();
    StopRule rule;
    rule.newPasses = plan.passes;
    rule.over = [&, start](int tiles, double ahead)
    {
        const double spent = _now() - start;
        if (tiles < whole) return mayGiveUp && _planner.givesUp(frame, plan.divider, tiles, spent);
        return spent + ahead >= frame.seconds;
    };
    const RenderProgress made =
        render(reduced ? *_reduced : *_session, plan.divider, rule, reduced ? nullptr : &_display);
    _planner.notePhotons(made.firstPhotonSeconds);
    if (!made.status.ok() || made.passes < 1) return false;
    _shown = reduced ? Shown::Reduced : Shown::Whole;
    _divider = plan.divider;
    _imageChanged |= made.newTiles == 0; // of an image that was there before
    return true;
}

/// Adds to what is shown.
void ViewTracer::traceStill(FrameSituation frame)
{
    const double start = _now();
    StopRule rule;
    // A tile at least, so that there is an end, however short the budget.
    rule.over = [&, start](int tiles, double ahead)
    { return tiles > 0 && _now() - start + ahead >= frame.seconds; };
    if (_shown == Shown::Reduced && _stillFrames < kSettling)
    {
        render(*_reduced, _divider, rule, nullptr);
        return;
    }
    if (_shown != Shown::Reduced) frame.tilesLeft = _session->tilesLeft();
    rule.newPasses = _planner.plan(frame).passes;
    // The display may lack whatever it did not hold before: then it is resolved.
    const bool addsToDisplay = _holdsFull && _resolved && same(_display.toneMap, *_resolved);
    _display.holdsImage = true;
    const RenderProgress made = render(*_session, 1, rule, addsToDisplay ? &_display : nullptr);
    if (!made.status.ok()) return;
    const Shown before = _shown;
    if (made.passes > 0)
        _shown = Shown::Whole;
    else if (made.newTiles > 0)
        _shown = Shown::Mixed;
    _imageChanged |= _shown != before && !_written;
    if (made.newTiles > 0) estimateError();
}

RenderProgress ViewTracer::render(RenderSession& session, int divider, StopRule& rule,
                                  const DisplayTarget* display)
{
    const View view = reducedView(_view, divider);
    session.setScene(_scene);
    session.setView(view);
    RenderOptions options = _options;
    options.centredFirstPass = divider > 1; // what is upsampled has to be what first hits tell of
    session.setOptions(options);
    rule.passes = _maxPasses;
    const double start = _now();
    leaveView(session, view);
    // Display values need more than the tile's pass where there is a history.
    const bool writes =
        display && display->rgba && !_history.leaving() && !historyCounts(session);
    const RenderProgress made = session.render(rule, {}, writes ? display : nullptr);
    enterView(session, view, made);
    _status = made.status;
    _newTiles += made.newTiles;
    if (made.restarted && _surfacesOf == &session) _surfacesOf = nullptr;
    const double seconds = _now() - start;
    _frame.traceSeconds += seconds;
    _planner.noteTiles(divider, made.newTiles, seconds - made.photonSeconds);
    if (made.restarted && &session == _session.get())
    {
        _relativeError = std::numeric_limits<double>::infinity();
        _nextEstimate = 2;
    }
    if (made.newTiles == 0) return made;

    // A pass that was cut short may have left tiles of two images in the display; it is not shown
    // then.
    const bool complete = made.status.ok() && (made.passes > 0 || (display && display->holdsImage));
    _written = writes && complete;
    _holdsFull = _written;
    _imageChanged = !_written;
    if (_written)
    {
        _resolved = display->toneMap;
        _resolvedDenoised = false;
    }
    return made;
}

/// Takes what the session's image is worth to the next one, if nothing but the view changes.
void ViewTracer::leaveView(RenderSession& session, const View& view)
{
    const bool sameScene = _imageScene.lock() == _scene;
    const bool sameSize = view.width == _imageView.width && view.height == _imageView.height;
    if (!sameScene) _viewDependence = viewDependence(_scene->scene());
    const bool keeps = _reprojects && &session == _imageOf && sameScene && sameSize &&
                       !_options.needsRestart(_imageOptions) && !_viewDependence.everywhere &&
                       session.progress().integrator != IntegratorKind::Debug;
    if (!keeps) _history.drop();
    if (keeps && session.progress().passes > 0 && view != _imageView)
        _history.leave(session, _imageView, *_workers);

    if (!keeps) _sequence = 0;
    session.setSequence(_history.leaving() ? _sequence + 1 : 0);
}

void ViewTracer::enterView(const RenderSession& session, const View& view, const RenderProgress& made)
{
    if (made.restarted && made.status.code != StatusCode::InvalidView)
    {
        _imageOf = &session;
        _imageScene = _scene;
        _imageView = view;
        _imageOptions = _options;
        if (_history.leaving()) ++_sequence;
    }
    if (_history.leaving() && made.passes > 0 && _imageView == view)
        _history.enter(session, view, _viewDependence, *_workers);
}

void ViewTracer::estimateError()
{
    const int passes = _session->progress().passes;
    if (passes < 2 || (passes < _nextEstimate && passes < _maxPasses)) return;
    const double start = _now();
    _relativeError = _session->estimateRelativeError();
    _estimateSeconds = _now() - start;
    _nextEstimate = passes + std::max(1, passes / 8);
}

bool ViewTracer::needsResolve(const SceneVersion& version)
{
    _toneMap = toneMapFromSettings(*version.settings, version.scene->scene());
    _denoises = denoises(*version.settings);
    return hasImage() && (_imageChanged || !_resolved || !same(_toneMap, *_resolved) ||
                          _denoises != _resolvedDenoised);
}

void ViewTracer::resolve(uint8_t* rgba, float* depth)
{
    switch (_shown)
    {
    case Shown::Whole:
        resolveImage(*_session, rgba, depth);
        break;
    case Shown::Reduced:
        if (_upsamples)
            showUpsampled(rgba, depth);
        else
            resolveImage(*_reduced, rgba, depth); // OpenGL enlarges it
        break;
    case Shown::Mixed:
        // Single tiles cannot be denoised: those of full resolution wait for all of them then.
        if (_upsamples)
            showUpsampled(rgba, depth);
        else
            enlargeReduced(rgba, depth);
        if (!_denoises) _session->resolveOver(_toneMap, rgba, depth);
        break;
    }
    _holdsFull = _shown != Shown::Reduced && !isStaged(image());
    _resolved = _toneMap;
    _resolvedDenoised = _denoises;
    _imageChanged = false;
}

/// With what is done to images after they are accumulated.
void ViewTracer::resolveImage(const RenderSession& session, uint8_t* rgba, float* depth)
{
    if (isStaged(session))
        showImage(stagedImage(session), _toneMap, *_workers, rgba, depth);
    else
        session.resolveDisplay(_toneMap, rgba, depth);
}

ShownImage ViewTracer::stagedImage(const RenderSession& session)
{
    ShownImage image = session.shownImage();
    if (historyCounts(session)) _history.blend(image, session.progress().passes, *_workers);
    if (!_denoises) return image;
    const double begin = _now();
    if (!_denoise) _denoise = std::make_unique<DenoiseFilter>();
    if (_surfacesOf != &session)
        _denoise->setSurfaces(session.surfaceSamples(), image.width, image.height, *_workers);
    _surfacesOf = &session;
    _denoise->filter(image, *_workers);
    _denoiseSeconds = _now() - begin;
    return image;
}

std::vector<float> ViewTracer::radiance()
{
    return isStaged(image()) ? stagedImage(image()).radiance : image().resolveRadiance();
}

/// To full resolution, along the edges of what is seen.
void ViewTracer::showUpsampled(uint8_t* rgba, float* depth)
{
    const double begin = _now();
    _reduced->showUpsampled(stagedImage(*_reduced), _reduced->surfaceSamples(), _view.width,
                            _view.height, {_toneMap, rgba, depth}, kMostTraced);
    // The first time takes longer than those after it.
    _upsampleSeconds = std::min((_now() - begin) / pixelsOf(_view), 1.1 * _upsampleSeconds);
}

/// To full resolution, with nothing but what its pixels hold.
void ViewTracer::enlargeReduced(uint8_t* rgba, float* depth)
{
    const int width = _reduced->width(), height = _reduced->height();
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<uint8_t> smallRgba(4 * pixels);
    std::vector<float> smallDepth(pixels);
    resolveImage(*_reduced, smallRgba.data(), smallDepth.data());
    const DisplayPixels small{width, height, smallRgba.data(), smallDepth.data()};
    const DisplayPixels large{_view.width, _view.height, rgba, depth};
    enlarge(small, large, *_workers);
}

void ViewTracer::noteShown()
{
    const double end = _now();
    _frame.seconds = end - _begin;
    _frame.divider = _shown == Shown::Whole ? 1 : _divider;
    if (_newTiles == 0) return;
    double& after = _afterSeconds[static_cast<int>(_showing)];
    const double seen = end - _traceEnd;
    after = after == 0.0 ? seen : after + 0.25 * (seen - after);
}

RenderProgress ViewTracer::progress() const
{
    if (!_session) return {};
    RenderProgress progress = image().progress();
    progress.status = _status;
    progress.relativeError =
        _shown == Shown::Whole ? _relativeError : std::numeric_limits<double>::infinity();
    progress.denoiseSeconds = _denoiseSeconds;
    progress.reprojectedShare = historyCounts(image()) ? _history.share() : 0.0;
    progress.reprojectSeconds = _history.seconds();
    return progress;
}

} // namespace osgRayTrace::engine
