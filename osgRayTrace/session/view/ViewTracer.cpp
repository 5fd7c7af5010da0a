// ViewTracer.cpp - the accumulated image of one view, frame after frame. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/ViewTracer.h"

#include "osgRayTrace/base/SteadySeconds.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

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

/// Takes over the inputs. Returns true if the last frame's image is not the one that is wanted now.
bool ViewTracer::takeInputs(const ViewInputs& inputs, const View& pass)
{
    bool moved = false;
    if (_workers != inputs.workers)
    {
        _workers = inputs.workers;
        _session = std::make_unique<RenderSession>(inputs.workers, inputs.photons);
        _reduced = std::make_unique<RenderSession>(inputs.workers, inputs.photons);
        _stages.reset(_workers);
        _reducedStages.reset(_workers);
        _displayState = DisplayState::Whole;
        moved = true;
    }
    _session->setHelp(inputs.help);
    _reduced->setHelp(inputs.help);
    if (inputs.scene != _scene)
    {
        // A session that is not shown would keep the last scene from being changed in place.
        (_displayState == DisplayState::Whole ? _reduced : _session)->clear();
        if (_displayState == DisplayState::Mixed) _displayState = DisplayState::Reduced;
        _scene = inputs.scene;
        moved = true;
    }
    moved |= inputs.options.needsRestart(_options);
    _options = inputs.options;
    if (!sameButForRounding(pass, _view))
    {
        _view = pass;
        _triedWhole = false;
        moved = true;
    }
    _maxPasses = inputs.maxPasses;
    _stages.setReprojects(inputs.reprojects);
    _reducedStages.setReprojects(inputs.reprojects);
    return moved;
}

bool ViewTracer::trace(const ViewInputs& inputs, const View& pass, const FrameBudget& budget,
                       uint8_t* rgba, float* depth)
{
    const ThreadSeam::Entry inside(_seam);
    _begin = _now();
    const bool moved = takeInputs(inputs, pass);
    _stillFrames = moved ? 0 : _stillFrames + 1;
    setDenoise(inputs.denoise);
    if (denoises()) rgba = nullptr; // denoising takes the whole image: resolve() does it
    _holdsFull = _holdsFull && rgba && !moved;
    // The first pass of a tile writes its depths.
    const bool holdsDepth = _holdsFull && _displayState == DisplayState::Whole;
    _changed.reset(_view.width, _view.height);
    _display = {shownBy(inputs), rgba, holdsDepth ? nullptr : depth};
    _display.changed = &_changed;
    _written = false;
    _upsampleBudget = budget.upsampleShare * budget.seconds;
    const FrameAgreement::Part agreed = joinFrame(budget, moved);
    _upsampleBudget *= agreed.share;
    setMostKept(inputs.keepsUnchanged);
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
        traceFixed(inputs.passesPerFrame);
    }
    else
    {
        traceBudgeted(budget, moved);
    }
    _presentCost = presentCostOfFrame();
    _traceEnd = _now();
    return _written;
}

/// Samples that are kept of earlier scenes have faded by the last pass. Views that agree keep none:
/// how many tiles a frame has time for differs from view to view.
void ViewTracer::setMostKept(bool keeps)
{
    const float most = std::min(ViewHistory::kMostKept, 0.5f * static_cast<float>(_maxPasses - 1));
    _stages.setMostKept(keeps && !_agreement ? most : 0.0f);
    _reducedStages.setMostKept(keeps && !_agreement ? most : 0.0f);
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
    // Upsampled images have to show what first hits tell of: a mixture of surfaces in one pixel
    // would have none's colour.
    options.centredFirstPass = divider > 1;
    session.setCentred(divider > 1);
    session.setOptions(options);
    rule.passes = _maxPasses;
    if (_interrupt)
        rule.shouldStop = [this, shouldStop = rule.shouldStop](int tiles, double ahead)
        { return _interrupt() || (shouldStop && shouldStop(tiles, ahead)); };
    const double start = _now();
    ImageStages& stages = stagesOf(session);
    stages.leaveView(session, inputs);
    // Tiles are shown while full resolution fills in, and otherwise the image when it is complete.
    const bool writes = display && display->rgba && !stages.changes(session) &&
                        (display->holdsImage || !stages.willChange());
    const RenderProgress result = session.render(rule, {}, writes ? display : nullptr);
    stages.enterView(session, inputs, result,
                     [this] { return (_interrupt && _interrupt()) || secondsLeft() <= 0.0; });
    _status = result.status;
    _newTiles += result.newTiles;
    const double all = _now() - start;
    _frame.traceSeconds += all;
    const double seconds = all - stages.freshSeconds();
    _planner.recordTiles(divider, result.newTiles, seconds - result.photonSeconds);
    TracedPart::Passes& passes = divider > 1 ? _part.reduced : _part.full;
    passes.tiles += result.newTiles;
    passes.seconds += seconds - result.photonSeconds;
    _part.photonSeconds += result.photonSeconds;
    if (result.restarted && &session == _session.get())
    {
        _error = ErrorEstimate();
        _nextEstimate = 2;
    }
    if (result.newTiles == 0) return result;

    // A pass that was cut short may have left tiles of two images in the display, and the display
    // is not shown then.
    const bool lacksDepth = result.restarted && display && !display->depth;
    const bool complete = result.status.ok() && !lacksDepth &&
                          (result.passes > 0 || (display && display->holdsImage));
    _written = writes && complete && !stages.changes(session);
    _holdsFull = _written;
    if (_written)
        _imageChanged = false;
    else if (result.passes > 0 || stages.isWhole(session) ||
             !denoises()) // single tiles cannot be denoised, and are not seen
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
    _error = _session->estimateError();
    _estimateSeconds = _now() - start;
    _nextEstimate = passes + std::max(1, passes / 8);
}

void ViewTracer::recordPresented()
{
    const ThreadSeam::Entry inside(_seam);
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

ViewProgress ViewTracer::progress() const
{
    if (!_session) return {};
    ViewProgress progress{image().progress(), {}};
    progress.status = _status;
    progress.error = _displayState == DisplayState::Whole ? _error : ErrorEstimate();
    progress.stages = imageStages().report(image());
    progress.stages.autoEv = _autoEv;
    return progress;
}

} // namespace osgRayTrace::engine
