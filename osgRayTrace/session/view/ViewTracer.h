// ViewTracer.h - the accumulated image of one view, frame after frame. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/ThreadSeam.h"
#include "osgRayTrace/film/ExposureMeter.h"
#include "osgRayTrace/session/RenderSession.h"
#include "osgRayTrace/session/view/FrameAgreement.h"
#include "osgRayTrace/session/view/FramePlan.h"
#include "osgRayTrace/session/view/ImageStages.h"
#include "osgRayTrace/session/view/ViewInputs.h"
#include "osgRayTrace/session/view/ViewProgress.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

/// Returns true if two views are the same but for rounding of depths. OSG's culling clamps the
/// planes of last frame's projection matrix again, so that the third column of a view at rest
/// wanders by its last digits; an image must go on nevertheless.
bool sameButForRounding(const View& a, const View& b);

/// How long a frame of a view may take, from trace() to recordPresented().
struct FrameBudget
{
    double seconds = 0.0; ///< seconds of a frame; 0: as long as the inputs' passes per frame take
    bool degrade = true;  ///< whether the resolution may be reduced while the view moves
    /// Share of the seconds that upsampling may take. Reduced images are upsampled to the largest
    /// size for which the share suffices to trace what is at edges; OpenGL enlarges the rest of the
    /// way. What is seen first tells more of a scene than fine light does.
    double upsampleShare = 0.65;
    /// If the agreement is not null, it says what this view traces, like all other views, and the
    /// seconds are for all of these views.
    std::shared_ptr<FrameAgreement> agreement = nullptr;
    uint64_t frameNumber = 0; ///< frame number for the agreement, see AgreedFrame
    bool again = false;
};

/// A view tracer has the sessions of a view that is drawn frame after frame: the tracer takes a
/// frame's matrices and inputs, and knows when there is something new to show. One thread at a time
/// may use it.
///
/// With a budget there are two sessions. While the view moves, and no whole pass of full resolution
/// fits into a frame, one session makes images of reduced resolution. When the view rests, the
/// other session adds tiles of full resolution, as many in each frame as there is time for, which
/// are shown over the enlarged last image; then it adds passes.
///
/// A view that rests while little changes in the scene goes on at full resolution: the image keeps
/// its samples where nothing near has changed, see ImageStages::keepView. A frame traces the tiles
/// that have pixels without kept samples, then others as long as there is time. If there is no time
/// for the former, the view is one that moves.
///
/// With an agreement the tracer does the same, but the agreement tells how much is traced, and no
/// clock ends the tracing.
class ViewTracer
{
public:
    /// Makes a tracer without an image. now is a clock [s], which tests replace.
    explicit ViewTracer(std::function<double()> now = {});

    /// Sets the function that any thread asks before each tile. If interrupt returns true, trace()
    /// makes no more tiles; parts of passes are kept, and the next trace() does the rest.
    void setInterrupt(std::function<bool()> interrupt) { _interrupt = std::move(interrupt); }

    /// Traces what a frame has time for, if the image needs any. The inputs have a scene. Failures
    /// are in progress(), and the image stays. Throws std::bad_alloc only. If rgba is not null,
    /// rgba and depth hold what the last frame was shown from, of the pass's size: they may take a
    /// new image as resolve() would write it, for less. Returns true if they did so: changed()
    /// tells which tiles were written.
    bool trace(const ViewInputs& inputs, const View& pass, const FrameBudget& budget = {},
               uint8_t* rgba = nullptr, float* depth = nullptr);

    /// Returns what the last trace() wrote to the display.
    const ChangedTiles& changed() const { return _changed; }

    /// Takes over tone map and denoiser. Returns true if the image, or one of the two, differs from
    /// what was resolved last, and false if there is no image.
    bool needsResolve(const ViewInputs& inputs);

    /// Returns whether the display's exposure is on its way to that of the image: another picture
    /// is due, even of a finished image.
    bool isExposureMoving() const { return _exposure.isMoving(); }

    /// Writes display values and window depths of displayWidth() * displayHeight() pixels.
    void resolve(uint8_t* rgba, float* depth);

    /// Records that the display no longer holds what was resolved last: the image has to be
    /// resolved again.
    void forgetDisplay();

    /// Lets go of the image and of all inputs: the next trace() begins as the first one does.
    void forget();

    /// Records that the frame that trace() began is on its way to the display.
    void recordPresented();

    /// Returns true if another trace() of the same inputs and view would do nothing.
    bool isDone() const
    {
        return _session && _status.ok() && _displayState == DisplayState::Whole &&
               _session->progress().passes >= _maxPasses;
    }

    /// These functions return the size of what resolve() writes: less than the pass's size while
    /// the resolution is reduced.
    int displayWidth() const
    {
        return upsamples() ? reducedSize(_view.width, displayDivider()) : image().width();
    }
    int displayHeight() const
    {
        return upsamples() ? reducedSize(_view.height, displayDivider()) : image().height();
    }

    bool hasImage() const
    {
        return _session && image().width() > 0 &&
               (image().progress().passes > 0 || imageStages().isWhole(image()));
    }

    /// Returns linear RGBA of the last whole image as it is shown, width() * height() pixels.
    std::vector<float> radiance();

    /// Returns a channel of the last whole image, width() * height() pixels; see RenderSession.
    std::vector<float> channel(Channel channel) const { return image().resolveChannel(channel); }
    int width() const { return image().width(); }
    int height() const { return image().height(); }

    /// Returns the progress of the last whole image. The error estimate is renewed when the passes
    /// have grown by an eighth: an estimate costs as much as a resolve.
    ViewProgress progress() const;
    const FrameReport& frame() const { return _frame; }

private:
    /// The image that is shown.
    enum class DisplayState
    {
        Whole, ///< each tile of full resolution has a pass
        Reduced,
        Mixed, ///< tiles of full resolution over the enlarged reduced image
    };

    /// The kinds of work that comes after tracing, by what the work costs.
    enum class PresentCost
    {
        Whole,      ///< the image of full resolution
        Tiles,      ///< some tiles, or their colours alone: the display has the rest
        Reduced,    ///< the reduced image as it is: OpenGL enlarges it
        Upsampled,  ///< the reduced image is upsampled, at least a part of the way
        FirstMixed, ///< the reduced image is enlarged
    };
    static constexpr int kPresentCosts = 5;

    /// Still frames before full resolution is begun: a hand that moves the view does not move it in
    /// every frame.
    static constexpr int kSettling = 2;

    bool takeInputs(const ViewInputs& inputs, const View& pass);
    void traceBudgeted(const FrameBudget& budget, bool moved);
    PresentCost presentCostOfFrame() const;
    FrameAgreement::Part joinFrame(const FrameBudget& budget, bool moved);
    PresentCost expectedPresentCost(bool moved) const;
    double deadlineOf(double budget, bool moved, PresentCost presentCost);
    double secondsLeft() const { return _begin + _deadline - _now(); }
    void traceFixed(int passes);
    void traceMoved(FrameSituation frame, double budget);
    bool traceKept(FrameSituation frame, double budget);
    bool beginsWhole(const FrameSituation& frame);
    bool traceImage(const FramePlan& plan, const FrameSituation& frame, bool mayGiveUp);
    void traceStill(FrameSituation frame);
    void traceAgreed(bool moved, FrameWork work, double budget);
    bool traceAgreedImage(const FrameWork& work, double budget);
    void traceAgreedProgress(const FrameWork& work);
    bool renderImage(int divider, StopRule& rule);
    void addToImage(StopRule& rule);
    RenderProgress render(RenderSession& session, int divider, StopRule& rule,
                          const DisplayTarget* display);
    void estimateError();
    void chooseUpsampling(double seconds);
    void meter();
    ToneMap shownBy(const ViewInputs& inputs);
    void presentReduced(int divider, uint8_t* rgba, float* depth);
    void enlargeReduced(uint8_t* rgba, float* depth);

    void setDenoise(DenoiseKind kind);
    void setMostKept(bool keeps);
    bool denoises() const { return _stages.denoises(); }
    ImageStages& stagesOf(const RenderSession& session)
    {
        return &session == _session.get() ? _stages : _reducedStages;
    }

    const ImageStages& imageStages() const
    {
        return _displayState == DisplayState::Whole ? _stages : _reducedStages;
    }

    /// Returns the cost of presenting a reduced image of this divider.
    PresentCost presentCostOf(int divider) const
    {
        return _upsampleDivider < divider ? PresentCost::Upsampled : PresentCost::Reduced;
    }
    /// Returns the divider of the width and height of what resolve() writes.
    int displayDivider() const
    {
        return _displayState == DisplayState::Reduced ? std::min(_upsampleDivider, _divider) : 1;
    }
    bool upsamples() const
    {
        return _displayState != DisplayState::Whole && displayDivider() < _divider;
    }
    const RenderSession& image() const
    {
        return _displayState == DisplayState::Whole ? *_session : *_reduced;
    }

    ThreadSeam _seam; ///< checks the functions that change the tracer
    std::function<double()> _now;
    std::function<bool()> _interrupt;
    std::shared_ptr<Workers> _workers;
    std::unique_ptr<RenderSession> _session; ///< full resolution
    std::unique_ptr<RenderSession>
        _reduced; ///< reduced resolution; has no image until one is needed
    DisplayState _displayState = DisplayState::Whole;
    int _divider = 1; ///< divider of the reduced image

    // The following are the inputs of the last frame.
    View _view;
    std::shared_ptr<const TracedScene> _scene;
    RenderOptions _options;
    int _maxPasses = 1;
    int _stillFrames = 0;     ///< frames since any of these changed
    bool _triedWhole = false; ///< whether beginsWhole() has been true since the view moved
    Status _status;

    ErrorEstimate _error;
    int _nextEstimate = 2; ///< passes at which the next estimate is made
    double _estimateSeconds = 0.0;

    // The following describe the time of the frame.
    FramePlanner _planner;
    FrameReport _frame;
    double _begin = 0.0;
    double _deadline = 0.0; ///< end of tracing, from _begin on
    double _traceEnd = 0.0;
    int _newTiles = 0;
    PresentCost _presentCost = PresentCost::Whole;
    double _afterSeconds[kPresentCosts] =
        {}; ///< by _presentCost: time from _traceEnd to recordPresented()

    // The following belong to the agreement of all views.
    std::shared_ptr<FrameAgreement> _agreement; ///< agreement of this frame; null: none
    std::shared_ptr<FrameAgreement::Member> _member;
    TracedPart _part; ///< the part of this frame
    /// The full resolution that the image at rest shall have, in parts of a pass; there is none
    /// before the view has moved under the agreement.
    std::optional<int64_t> _agreedProgress;

    // The following describe the contents of the display.
    ToneMap _toneMap;
    EasedExposure _exposure; ///< what the meter has told, with RayTraceSettings::setAutoExposure
    float _autoEv = 0.0f;    ///< what of it the display has [EV]
    DisplayTarget _display;  ///< target of this frame; rgba is null if it cannot be used
    bool _written = false;   ///< whether the image of the frame is in _display
    ChangedTiles _changed;   ///< the tiles that this frame wrote
    bool _holdsFull =
        false; ///< whether the display has the image in full size, so that tiles may be added
    bool _imageChanged = false; ///< whether the image has changed since it was resolved
    std::optional<ToneMap> _resolved;

    // The following are the stages between the sessions and the display.
    ImageStages _stages, _reducedStages; ///< stages of _session and of _reduced
    double _upsampleBudget = 0.0;        ///< [s]
    int _upsampleDivider = 1;    ///< divider of the size that reduced images are upsampled to
    int _ownUpsampleDivider = 1; ///< divider of the finest size for which there is time
    DenoiseKind _resolvedDenoise = DenoiseKind::Off;
};

} // namespace osgRayTrace::engine
