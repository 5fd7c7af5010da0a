// ViewTracer.cpp - the accumulated image of one view, frame after frame. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/ViewTracer.h"

#include "osgRayTrace/bridge/update/RenderOptionsFromSettings.h"
#include "osgRayTrace/film/Enlarge.h"

#include <algorithm>
#include <atomic>
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

/// Tiles at rest are made in squares of so many a side: what lies together is copied to the display
/// in one go. Only if there is time for so many squares in a frame, as they shall tell of the costs
/// of all.
constexpr int kGroup = 4;
constexpr int kFewGroups = 16;

/// What the display takes to copy a pixel, until it is known [s]; and to be enlarged first, into
/// memory that is new.
constexpr double kCopySeconds = 2e-9, kEnlargeSeconds = 6e-9;

double steadySeconds()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

double pixelsOf(const View& view)
{
    return double(view.width) * view.height;
}

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

ViewTracer::ViewTracer(std::function<double()> now)
    : _now(now ? std::move(now) : steadySeconds), _stages(_now), _reducedStages(_now)
{
}

/// True if the image of the last frame is not the one that is wanted now.
bool ViewTracer::takeInputs(const SceneVersion& version, const View& pass)
{
    bool moved = false;
    if (_workers != version.workers)
    {
        _workers = version.workers;
        _session = std::make_unique<RenderSession>(version.workers, version.photons);
        _reduced = std::make_unique<RenderSession>(version.workers, version.photons);
        _stages.reset(_workers);
        _reducedStages.reset(_workers);
        _displayState = DisplayState::Whole;
        moved = true;
    }
    if (version.scene != _scene)
    {
        // What is not shown would only keep the last version of the scene from being changed in
        // place.
        (_displayState == DisplayState::Whole ? _reduced : _session)->clear();
        if (_displayState == DisplayState::Mixed) _displayState = DisplayState::Reduced;
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
    _stages.setReprojects(version.settings->getReproject());
    _reducedStages.setReprojects(version.settings->getReproject());
    return moved;
}

bool ViewTracer::trace(const SceneVersion& version, const View& pass, const FrameBudget& budget,
                       uint8_t* rgba, float* depth)
{
    _begin = _now();
    const bool moved = takeInputs(version, pass);
    _stillFrames = moved ? 0 : _stillFrames + 1;
    setDenoise(denoiseKind(*version.settings));
    if (denoises()) rgba = nullptr; // that takes the whole image: resolve() does it
    _holdsFull = _holdsFull && rgba && !moved;
    // Depths are those of each tile's first pass.
    const bool holdsDepth = _holdsFull && _displayState == DisplayState::Whole;
    _changed.reset(_view.width, _view.height);
    _display = {toneMapFromSettings(*version.settings, version.scene->scene()), rgba,
                holdsDepth ? nullptr : depth};
    _display.changed = &_changed;
    _written = false;
    _upsampleBudget = budget.upsampleShare * budget.seconds;
    const FrameAgreement::Part agreed = joinFrame(budget, moved);
    _upsampleBudget *= agreed.share;
    if (moved) chooseUpsampling(_upsampleBudget);
    if (moved) _upsampleDivider = _agreement ? agreed.work.upsampleDivider : _ownUpsampleDivider;
    _frame.traceSeconds = 0.0;
    _newTiles = 0;

    if (_agreement)
    {
        traceAgreed(moved, agreed.work, budget.seconds);
    }
    else if (!(budget.seconds > 0.0))
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
        setDeadline(budget.seconds, moved, expectedPresentCost(moved));
        frame.seconds = secondsLeft();
        if (moved)
            traceMoved(frame, budget.seconds);
        else
            traceStill(frame);
    }
    if (_displayState == DisplayState::Reduced)
        _presentCost = presentCostOf(_divider);
    else if (_written)
        _presentCost = _display.holdsImage ? PresentCost::Tiles : PresentCost::Whole;
    else
        _presentCost =
            _displayState == DisplayState::Mixed ? PresentCost::FirstMixed : PresentCost::Whole;
    _traceEnd = _now();
    return _written;
}

/// What all views agree on for the frame, if they do.
FrameAgreement::Part ViewTracer::joinFrame(const FrameBudget& budget, bool moved)
{
    if (_agreement != budget.agreement)
    {
        _agreement = budget.agreement;
        _member = _agreement ? _agreement->join() : nullptr;
        _agreedProgress.reset();
    }
    _part = TracedPart();
    if (!_agreement) return {};
    const AgreedFrame frame{budget.frameNumber, budget.again, budget.seconds, budget.degrade};
    return _agreement->begin(*_member, frame, _view.width, _view.height, moved, _begin);
}

/// Held while it fits, so that a view that moves does not change its sharpness in each frame.
void ViewTracer::chooseUpsampling(double seconds)
{
    constexpr double kSpare = 0.7;
    const auto takes = [&](int divider)
    {
        return _reducedStages.upsampleSeconds(reducedSize(_view.width, divider),
                                              reducedSize(_view.height, divider));
    };
    int finest = 1;
    while (finest < FramePlanner::kLargestDivider && takes(finest) > kSpare * seconds)
        ++finest;
    int& held = _ownUpsampleDivider;
    if (finest < held || takes(held) > seconds) held = finest;
}

/// A view that moves is taken to have the resolution that it had when it moved last.
ViewTracer::PresentCost ViewTracer::expectedPresentCost(bool moved) const
{
    if (moved && !_planner.knowsCosts()) return presentCostOf(FramePlanner::kFirstDivider);
    const bool reduced =
        moved ? _divider > 1 : _displayState == DisplayState::Reduced && _stillFrames < kSettling;
    if (reduced) return presentCostOf(_divider);
    if (_holdsFull) return PresentCost::Tiles;
    return !moved && _displayState == DisplayState::Reduced ? PresentCost::FirstMixed
                                                            : PresentCost::Whole;
}

/// What comes after tracing will take as long as it did.
void ViewTracer::setDeadline(double budget, bool moved, PresentCost presentCost)
{
    const bool upsampled = presentCost == PresentCost::Upsampled;
    const View shown = upsampled ? reducedView(_view, _upsampleDivider) : _view;
    const double pixels = pixelsOf(shown);
    double& after = _afterSeconds[static_cast<int>(presentCost)];
    if (after == 0.0) // a guess
    {
        if (presentCost != PresentCost::Reduced) after = pixels * kCopySeconds;
        if (presentCost == PresentCost::FirstMixed) after = pixels * kEnlargeSeconds;
        if (upsampled) after += _reducedStages.upsampleSeconds(shown.width, shown.height);
    }
    double seconds = budget - after;
    // Each thread ends the tile that it is at.
    seconds -= _planner.tileSeconds(upsampled || presentCost == PresentCost::Reduced ? 2 : 1) *
               _workers->threads();
    const int passes = _session->progress().passes;
    if (!moved && passes + 1 >= _nextEstimate) seconds -= _estimateSeconds;
    _deadline = std::max(seconds, kLeastShare * budget);
}

void ViewTracer::traceFixed(int passes)
{
    StopRule rule;
    rule.newPasses = passes;
    const bool continues = _displayState == DisplayState::Whole;
    const RenderProgress result = render(*_session, 1, rule, &_display);
    if (!result.status.ok() || result.passes < 1) return;
    _displayState = DisplayState::Whole;
    _imageChanged |= !continues && result.newTiles == 0;
    if (result.newTiles > 0) estimateError();
}

/// Time for one whole pass, at any resolution, must be.
void ViewTracer::traceMoved(FrameSituation frame, double budget)
{
    const bool guessed = frame.degrade && !_planner.knowsCosts();
    FramePlan plan = _planner.plan(frame);
    if (plan.divider > 1)
    {
        setDeadline(budget, true, presentCostOf(plan.divider));
        frame.seconds = secondsLeft();
    }
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
    if (!reduced) rule.newPasses = plan.passes; // in the last of which tiles go to the display
    rule.shouldStop = [&, start](int tiles, double ahead)
    {
        const double spent = _now() - start;
        if (tiles < whole) return mayGiveUp && _planner.givesUp(frame, plan.divider, tiles, spent);
        return spent + ahead >= frame.seconds;
    };
    return renderImage(plan.divider, rule);
}

/// False if there is no whole pass of it.
bool ViewTracer::renderImage(int divider, StopRule& rule)
{
    const bool reduced = divider > 1;
    const RenderProgress result =
        render(reduced ? *_reduced : *_session, divider, rule, reduced ? nullptr : &_display);
    _planner.recordPhotons(result.firstPhotonSeconds);
    if (!result.status.ok() || result.passes < 1) return false;
    _displayState = reduced ? DisplayState::Reduced : DisplayState::Whole;
    _divider = divider;
    _imageChanged |= result.newTiles == 0; // of an image that was there before
    return true;
}

/// Adds to what is shown.
void ViewTracer::traceStill(FrameSituation frame)
{
    const double start = _now();
    StopRule rule;
    // A tile at least, so that there is an end, however short the budget.
    rule.shouldStop = [&, start](int tiles, double ahead)
    { return tiles > 0 && _now() - start + ahead >= frame.seconds; };
    if (_displayState == DisplayState::Reduced && _stillFrames < kSettling)
    {
        render(*_reduced, _divider, rule, nullptr);
        return;
    }
    if (_displayState != DisplayState::Reduced) frame.tilesLeft = _session->tilesLeft();
    const double groupSeconds = kGroup * kGroup * _planner.tileSeconds(1);
    if (groupSeconds > 0.0 && kFewGroups * groupSeconds < frame.seconds) rule.groupedTiles = kGroup;
    rule.newPasses = _planner.plan(frame).passes;
    addToImage(rule);
}

/// Tiles and passes of full resolution, of a view at rest.
void ViewTracer::addToImage(StopRule& rule)
{
    // The display may lack whatever it did not hold before: then it is resolved.
    const bool addsToDisplay = _holdsFull && _resolved && same(_display.toneMap, *_resolved);
    _display.holdsImage = true;
    const RenderProgress result = render(*_session, 1, rule, addsToDisplay ? &_display : nullptr);
    if (!result.status.ok()) return;
    const DisplayState before = _displayState;
    if (result.passes > 0)
        _displayState = DisplayState::Whole;
    else if (result.newTiles > 0)
        _displayState = DisplayState::Mixed;
    _imageChanged |= _displayState != before && !_written;
    if (result.newTiles > 0) estimateError();
}

void ViewTracer::traceAgreed(bool moved, FrameWork work, double budget)
{
    if (moved)
    {
        if (!traceAgreedImage(work, budget) && _status.ok())
        {
            work = _agreement->giveUp(*_member, _part);
            TracedPart rest;
            rest.lostSeconds = _frame.traceSeconds;
            _part = rest;
            traceAgreedImage(work, 0.0);
        }
        const int passes = image().progress().passes;
        if (passes < std::min(work.passes, _maxPasses)) _agreement->cutShort(*_member, passes);
        _agreedProgress =
            _displayState == DisplayState::Whole ? int64_t(passes) * FrameWork::kWholePass : 0;
    }
    else if (_displayState == DisplayState::Reduced && _stillFrames < kSettling)
    {
        StopRule rule;
        rule.newPasses = work.passes;
        render(*_reduced, _divider, rule, nullptr);
    }
    else
    {
        traceAgreedProgress(work);
    }
}

/// As many passes as all views make, at the resolution of all. False if it was given up, or failed.
/// budget: of all views [s]; 0: it is not given up.
bool ViewTracer::traceAgreedImage(const FrameWork& work, double budget)
{
    const int whole =
        tilesOf(reducedSize(_view.width, work.divider), reducedSize(_view.height, work.divider));
    StopRule rule;
    rule.newPasses = work.passes;
    // Photons, which no other resolution makes fewer, do not count: it is asked after them first.
    std::atomic<double> start{-std::numeric_limits<double>::infinity()};
    if (budget > 0.0)
        rule.shouldStop = [&](int tiles, double)
        {
            if (tiles < whole && work.divider >= FramePlanner::kLargestDivider) return false;
            const double now = _now();
            double none = -std::numeric_limits<double>::infinity();
            if (start.compare_exchange_strong(none, now)) return false;
            return now - none > FrameAgreement::farTooLong(budget);
        };
    return renderImage(work.divider, rule);
}

/// What the view at rest has of full resolution is the same share of its tiles in all views, so
/// that they complete their passes in the same frames.
void ViewTracer::traceAgreedProgress(const FrameWork& work)
{
    constexpr int64_t kWhole = FrameWork::kWholePass;
    const int64_t tiles = tilesOf(_view.width, _view.height);
    const bool begun = _displayState != DisplayState::Reduced;
    const int64_t done =
        begun ? _session->progress().passes * tiles + tiles - _session->tilesLeft() : 0;
    if (!_agreedProgress) _agreedProgress = done * kWhole / tiles;
    _agreedProgress = std::min(*_agreedProgress + work.progress, _maxPasses * kWhole);
    _part.progress = static_cast<int>(*_agreedProgress % kWhole);

    const int64_t wanted = *_agreedProgress * tiles / kWhole;
    if (wanted <= done) return;
    StopRule rule;
    rule.newTiles =
        static_cast<int>(std::min<int64_t>(wanted - done, std::numeric_limits<int>::max()));
    rule.newPasses = static_cast<int>((wanted + tiles - 1) / tiles - done / tiles);
    _part.photonPasses =
        static_cast<int>((wanted + tiles - 1) / tiles - (done + tiles - 1) / tiles);
    addToImage(rule);
}

void ViewTracer::setDenoise(DenoiseKind kind)
{
    _stages.setDenoise(kind);
    _reducedStages.setDenoise(kind);
}

RenderProgress ViewTracer::render(RenderSession& session, int divider, StopRule& rule,
                                  const DisplayTarget* display)
{
    const ImageInputs inputs{_scene, reducedView(_view, divider), _options};
    session.setScene(_scene);
    session.setView(inputs.view);
    RenderOptions options = _options;
    options.centredFirstPass = divider > 1; // what is upsampled has to be what first hits tell of
    session.setOptions(options);
    rule.passes = _maxPasses;
    if (_interrupt)
        rule.shouldStop = [this, shouldStop = rule.shouldStop](int tiles, double ahead)
        { return _interrupt() || (shouldStop && shouldStop(tiles, ahead)); };
    const double start = _now();
    ImageStages& stages = stagesOf(session);
    stages.leaveView(session, inputs);
    // Of what fills in, tiles are shown as they are; else the whole image is, once it is there.
    const bool writes = display && display->rgba && !stages.changes(session) &&
                        (display->holdsImage || !stages.willChange());
    const RenderProgress result = session.render(rule, {}, writes ? display : nullptr);
    stages.enterView(session, inputs, result);
    _status = result.status;
    _newTiles += result.newTiles;
    const double seconds = _now() - start;
    _frame.traceSeconds += seconds;
    _planner.recordTiles(divider, result.newTiles, seconds - result.photonSeconds);
    TracedPart::Passes& passes = divider > 1 ? _part.reduced : _part.full;
    passes.tiles += result.newTiles;
    passes.seconds += seconds - result.photonSeconds;
    _part.photonSeconds += result.photonSeconds;
    if (result.restarted && &session == _session.get())
    {
        _relativeError = std::numeric_limits<double>::infinity();
        _nextEstimate = 2;
    }
    if (result.newTiles == 0) return result;

    // A pass that was cut short may have left tiles of two images in the display; it is not shown
    // then.
    const bool lacksDepth = result.restarted && display && !display->depth;
    const bool complete = result.status.ok() && !lacksDepth &&
                          (result.passes > 0 || (display && display->holdsImage));
    _written = writes && complete && !stages.changes(session);
    _holdsFull = _written;
    if (_written)
        _imageChanged = false;
    else if (result.passes > 0 || !denoises()) // single tiles cannot be denoised: they are not seen
        _imageChanged = true;
    if (_written)
    {
        _resolved = display->toneMap;
        _resolvedDenoise = DenoiseKind::Off;
    }
    return result;
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
    setDenoise(denoiseKind(*version.settings));
    return hasImage() && (_imageChanged || !_resolved || !same(_toneMap, *_resolved) ||
                          _stages.denoise() != _resolvedDenoise);
}

void ViewTracer::resolve(uint8_t* rgba, float* depth)
{
    switch (_displayState)
    {
    case DisplayState::Whole:
        _stages.show(*_session, _toneMap, rgba, depth);
        break;
    case DisplayState::Reduced:
        presentReduced(displayDivider(), rgba, depth);
        break;
    case DisplayState::Mixed:
        // Single tiles cannot be denoised: those of full resolution wait for all of them then.
        enlargeReduced(rgba, depth);
        if (!denoises()) _session->resolveOver(_toneMap, rgba, depth);
        break;
    }
    _holdsFull = _displayState == DisplayState::Reduced ? displayDivider() == 1 && !denoises()
                                                        : !stagesOf(image()).changes(image());
    _resolved = _toneMap;
    _resolvedDenoise = _stages.denoise();
    _imageChanged = false;
}

std::vector<float> ViewTracer::radiance()
{
    return stagesOf(image()).radiance(image());
}

/// Upsampled along the edges of what is seen if the divider is less than that of the image.
void ViewTracer::presentReduced(int divider, uint8_t* rgba, float* depth)
{
    if (divider == _divider)
        _reducedStages.show(*_reduced, _toneMap, rgba, depth);
    else
        _reducedStages.presentUpsampled(*_reduced, reducedSize(_view.width, divider),
                                        reducedSize(_view.height, divider), {_toneMap, rgba, depth},
                                        _upsampleBudget);
}

/// To full resolution: as far as there is time for it along edges, then with nothing but what
/// pixels hold.
void ViewTracer::enlargeReduced(uint8_t* rgba, float* depth)
{
    const int divider = std::min(_upsampleDivider, _divider);
    if (divider == 1) return presentReduced(1, rgba, depth);
    const int width = reducedSize(_view.width, divider),
              height = reducedSize(_view.height, divider);
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<uint8_t> smallRgba(4 * pixels);
    std::vector<float> smallDepth(pixels);
    presentReduced(divider, smallRgba.data(), smallDepth.data());
    const DisplayPixels small{width, height, smallRgba.data(), smallDepth.data()};
    const DisplayPixels large{_view.width, _view.height, rgba, depth};
    enlarge(small, large, *_workers);
}

void ViewTracer::forgetDisplay()
{
    _holdsFull = false;
    _resolved.reset();
}

void ViewTracer::recordPresented()
{
    const double end = _now();
    _frame.seconds = end - _begin;
    _frame.divider = _displayState == DisplayState::Whole ? 1 : _divider;
    _part.upsampleDivider = _ownUpsampleDivider;
    if (_agreement) _agreement->end(*_member, _part, end);
    if (_newTiles == 0) return;
    double& after = _afterSeconds[static_cast<int>(_presentCost)];
    const double seen = end - _traceEnd;
    after = seen > 1.5 * after ? seen : after + (seen > after ? 0.5 : 0.25) * (seen - after);
}

RenderProgress ViewTracer::progress() const
{
    if (!_session) return {};
    RenderProgress progress = image().progress();
    progress.status = _status;
    progress.relativeError = _displayState == DisplayState::Whole
                                 ? _relativeError
                                 : std::numeric_limits<double>::infinity();
    (_displayState == DisplayState::Whole ? _stages : _reducedStages).report(image(), progress);
    return progress;
}

} // namespace osgRayTrace::engine
