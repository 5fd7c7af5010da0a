// ViewTracerFrames.cpp - what a view traces in the time that a frame has. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/ViewTracer.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/history/FreshSamples.h"

#include <algorithm>
#include <limits>

namespace osgRayTrace::engine
{

namespace
{

/// This share of a frame is traced in even if all that comes after tracing takes longer than the
/// budget.
constexpr double kLeastShare = 0.2;

/// A view at rest gets its tiles in squares of kGroup tiles a side: tiles that lie together are
/// copied to the display in one go. Squares are used only if a frame has time for kFewGroups of
/// them, as these squares shall tell the costs of all.
constexpr int kGroup = 4;
constexpr int kFewGroups = 16;

/// These are guesses of the time that the display takes to copy a pixel, and to enlarge a pixel
/// first into new memory [s].
constexpr double kCopySeconds = 2e-9, kEnlargeSeconds = 6e-9;

double pixelsOf(const View& view)
{
    return double(view.width) * view.height;
}

} // namespace

/// Chooses the divider of upsampling, and keeps it while it fits, so that a moving view does not
/// change its sharpness in each frame.
void ViewTracer::chooseUpsampling(double seconds)
{
    constexpr double kSpare = 0.9;
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

/// Returns the cost of presenting the frame. A view that moves is taken to have the resolution that
/// it had when it moved last.
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

/// Returns the cost of presenting what was traced in this frame.
ViewTracer::PresentCost ViewTracer::presentCostOfFrame() const
{
    if (_displayState == DisplayState::Reduced) return presentCostOf(_divider);
    if (_written) return _display.holdsImage ? PresentCost::Tiles : PresentCost::Whole;
    return _displayState == DisplayState::Mixed ? PresentCost::FirstMixed : PresentCost::Whole;
}

/// Returns the deadline of tracing. The work after tracing is expected to take as long as it did
/// last.
double ViewTracer::deadlineOf(double budget, bool moved, PresentCost presentCost)
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
    // Each thread ends the tile at work.
    seconds -= _planner.tileSeconds(upsampled || presentCost == PresentCost::Reduced ? 2 : 1) *
               _workers->threads();
    const int passes = _session->progress().passes;
    if (!moved && passes + 1 >= _nextEstimate) seconds -= _estimateSeconds;
    return std::max(seconds, kLeastShare * budget);
}

void ViewTracer::traceFixed(int passes)
{
    _deadline = std::numeric_limits<double>::infinity();
    StopRule rule;
    rule.newPasses = passes;
    const bool continues = _displayState == DisplayState::Whole;
    const RenderProgress result = render(*_session, 1, rule, &_display);
    if (!result.status.ok() || result.passes < 1) return;
    _displayState = DisplayState::Whole;
    _imageChanged |= !continues && result.newTiles == 0;
    if (result.newTiles > 0) estimateError();
}

void ViewTracer::traceBudgeted(const FrameBudget& budget, bool moved)
{
    FrameSituation frame;
    frame.width = _view.width;
    frame.height = _view.height;
    frame.moved = moved;
    frame.degrade = budget.degrade;
    _deadline = deadlineOf(budget.seconds, moved, expectedPresentCost(moved));
    frame.seconds = secondsLeft();
    frame.fullSeconds =
        frame.seconds + deadlineOf(budget.seconds, moved, PresentCost::Whole) - _deadline;
    if (moved && traceKept(frame, budget.seconds)) return;
    if (moved)
        traceMoved(frame, budget.seconds);
    else
        traceStill(frame);
}

/// Traces tiles of full resolution over what the image keeps of the scene's last version. Returns
/// false if nothing is kept, or if there is no time for all tiles that lack kept samples.
bool ViewTracer::traceKept(FrameSituation frame, double budget)
{
    constexpr double kMostShare = 0.9;    // of the frame, for tiles that lack kept samples
    constexpr double kMostForFresh = 0.3; // of the frame, for more samples of pixels that keep few
    constexpr double kSparse = 2.0;       // pixels here and there take longer than those of tiles
    if (_displayState != DisplayState::Whole || !_planner.knowsCosts()) return false;
    if (!_stages.keepView(*_session, {_scene, _view, _options})) return false;
    const std::vector<uint8_t>& lacking = _stages.lackingTiles();
    const auto needed = static_cast<int>(std::count(lacking.begin(), lacking.end(), uint8_t(1)));
    _deadline = deadlineOf(budget, true, PresentCost::Whole);
    frame.seconds = frame.fullSeconds = secondsLeft();
    if (frame.degrade && needed * _planner.tileSeconds(1) > kMostShare * frame.seconds)
    {
        _stages.forgetKept();
        return false;
    }
    const double perSample = kSparse * _planner.tileSeconds(1) / kTilePixels;
    frame.seconds -=
        std::min(kMostForFresh * frame.seconds,
                 kMostFresh * static_cast<double>(_stages.lackingPixels()) * perSample);
    const double start = _now();
    StopRule rule;
    rule.firstTiles = &lacking;
    rule.shouldStop = [&, start](int tiles, double ahead)
    { return tiles >= needed && _now() - start + ahead >= frame.seconds; };
    frame.moved = false;
    rule.newPasses = _planner.plan(frame).passes;
    addToImage(rule);
    return true;
}

/// Returns whether a view that rests takes one whole pass of full resolution although there is no
/// time for one: the scene has changed a little in each of the last frames, and would go on to do
/// so. The following frames keep what that pass has traced.
bool ViewTracer::beginsWhole(const FrameSituation& frame)
{
    constexpr double kLongest = 12.0; // frames
    const double seconds = _planner.tileSeconds(1) * tilesOf(frame.width, frame.height);
    if (_triedWhole || seconds > kLongest * frame.fullSeconds ||
        _reducedStages.versionsKept() < kSettling)
        return false;
    _triedWhole = true;
    return true;
}

/// Traces one whole pass at least, at whatever resolution.
void ViewTracer::traceMoved(FrameSituation frame, double budget)
{
    const bool guessed = frame.degrade && !_planner.knowsCosts();
    FramePlan plan = _planner.plan(frame);
    const bool whole =
        plan.divider > 1 && _displayState == DisplayState::Reduced && beginsWhole(frame);
    if (whole) plan = FramePlan();
    const bool reduced = plan.divider > 1;
    _deadline =
        deadlineOf(budget, true, reduced ? presentCostOf(plan.divider) : PresentCost::Whole);
    frame.seconds = secondsLeft();
    bool traced = traceImage(plan, frame, frame.degrade && !whole);
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

/// Traces a whole pass of a new image, and more if there is time. Returns false if the pass was
/// given up or failed.
bool ViewTracer::traceImage(const FramePlan& plan, const FrameSituation& frame, bool mayGiveUp)
{
    const bool reduced = plan.divider > 1;
    const int whole =
        tilesOf(reducedSize(_view.width, plan.divider), reducedSize(_view.height, plan.divider));
    const double start = _now();
    StopRule rule;
    if (!reduced) rule.newPasses = plan.passes; // in the last pass tiles go to the display
    rule.shouldStop = [&, start](int tiles, double ahead)
    {
        const double spent = _now() - start;
        if (tiles < whole) return mayGiveUp && _planner.givesUp(frame, plan.divider, tiles, spent);
        return spent + ahead >= frame.seconds;
    };
    return renderImage(plan.divider, rule);
}

/// Makes the image at the divider. Returns false if the image has no whole pass.
bool ViewTracer::renderImage(int divider, StopRule& rule)
{
    const bool reduced = divider > 1;
    const RenderProgress result =
        render(reduced ? *_reduced : *_session, divider, rule, reduced ? nullptr : &_display);
    _planner.recordPhotons(result.firstPhotonSeconds);
    if (!result.status.ok() || result.passes < 1) return false;
    _displayState = reduced ? DisplayState::Reduced : DisplayState::Whole;
    _divider = divider;
    _imageChanged |= result.newTiles == 0; // the image was there before
    return true;
}

/// Adds samples to the image that is shown.
void ViewTracer::traceStill(FrameSituation frame)
{
    const double start = _now();
    StopRule rule;
    // A tile at least is made, however short the budget, so that the image is completed.
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

/// Adds tiles and passes of full resolution to the image of a view at rest.
void ViewTracer::addToImage(StopRule& rule)
{
    // The display may lack tiles that it did not hold before: then the image is resolved.
    const bool addsToDisplay = _holdsFull && _resolved && _display.toneMap == *_resolved;
    _display.holdsImage = true;
    const RenderProgress result = render(*_session, 1, rule, addsToDisplay ? &_display : nullptr);
    if (!result.status.ok()) return;
    const DisplayState before = _displayState;
    if (result.passes > 0 || _stages.isWhole(*_session))
        _displayState = DisplayState::Whole;
    else if (result.newTiles > 0)
        _displayState = DisplayState::Mixed;
    _imageChanged |= _displayState != before && !_written;
    if (result.newTiles > 0) estimateError();
}

} // namespace osgRayTrace::engine
