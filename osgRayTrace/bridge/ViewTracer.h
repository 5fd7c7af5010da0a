// ViewTracer.h - the accumulated image of one view, frame after frame. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/SceneUpdater.h"
#include "osgRayTrace/session/DenoiseFilter.h"
#include "osgRayTrace/session/FramePlan.h"
#include "osgRayTrace/session/RenderSession.h"
#include "osgRayTrace/session/ViewHistory.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

/// How long a frame of a view may take, from trace() to noteShown().
struct FrameBudget
{
    double seconds = 0.0; ///< 0: as long as the settings' passes per frame take
    bool degrade = true;  ///< the resolution may be reduced while the view moves
    /// Reduced images are upsampled along edges if that takes no more than this of the seconds; else OpenGL
    /// enlarges them.
    double upsampleShare = 0.2;
};

/// Of the last frame.
struct FrameReport
{
    int divider =
        1; ///< of the width and height of what is shown; 1 as well where tiles are still missing
    double seconds = 0.0;      ///< from trace() to noteShown()
    double traceSeconds = 0.0; ///< of these, in passes and photons
};

/// A RenderSession under OSG: takes a frame's matrices and settings, and knows when there is
/// something new to show. One thread at a time.
///
/// With a budget there are two sessions. While the view moves, and no whole pass of full resolution
/// fits into a frame, one makes images of reduced resolution. When the view rests the other adds
/// tiles of full resolution, as many in each frame as there is time for, which are shown over the
/// enlarged last image; then passes.
class ViewTracer
{
public:
    /// now: a clock [s], for tests.
    explicit ViewTracer(std::function<double()> now = {});

    /// Traces what a frame has time for, if the image needs any. Failures are in progress(),
    /// the image stays. Throws std::bad_alloc only.
    /// If rgba is not null, it and depth are what the last frame was shown from, of the pass's
    /// size: they may take a new image as resolve() would write it, for less. True if they did.
    bool trace(const SceneVersion& version, const View& pass, const FrameBudget& budget = {},
               uint8_t* rgba = nullptr, float* depth = nullptr);

    /// Takes the settings of how the image is shown. True if the image, or that, differs from what
    /// was resolved last. False if there is no image.
    bool needsResolve(const SceneVersion& version);

    /// Display values and window depths, shownWidth() * shownHeight() pixels.
    void resolve(uint8_t* rgba, float* depth);

    /// The frame that trace() began is on its way to the display.
    void noteShown();

    /// Of the pixels of a reduced image, those that may be traced to upsample it.
    static constexpr double kMostTraced = 0.25;

    /// Of what resolve() writes: less than the pass's while the resolution is reduced.
    int shownWidth() const { return enlarges() ? _view.width : image().width(); }
    int shownHeight() const { return enlarges() ? _view.height : image().height(); }

    bool hasImage() const
    {
        return _session && image().width() > 0 && image().progress().passes > 0;
    }

    /// Linear RGBA of the last whole image as it is shown, width() * height() pixels.
    std::vector<float> radiance();
    int width() const { return image().width(); }
    int height() const { return image().height(); }

    /// Of that image. The error estimate is renewed when the passes have grown by an eighth: it
    /// costs as much as a resolve.
    RenderProgress progress() const;
    const FrameReport& frame() const { return _frame; }

private:
    /// What is shown.
    enum class Shown
    {
        Whole, ///< each tile of full resolution has a pass
        Reduced,
        Mixed, ///< tiles of full resolution over the enlarged reduced image
    };

    /// What comes after tracing.
    enum class Showing
    {
        Whole,
        Reduced,
        FirstMixed, ///< the reduced image is enlarged
    };

    bool takeInputs(const SceneVersion& version, const View& pass);
    void setDeadline(double budget, bool moved);
    double secondsLeft() const { return _begin + _deadline - _now(); }
    void traceFixed(int passes);
    void traceMoved(FrameSituation frame);
    bool traceImage(const FramePlan& plan, const FrameSituation& frame, bool mayGiveUp);
    void traceStill(FrameSituation frame);
    RenderProgress render(RenderSession& session, int divider, StopRule& rule,
                          const DisplayTarget* display);
    void estimateError();
    void resolveImage(const RenderSession& session, uint8_t* rgba, float* depth);
    ShownImage stagedImage(const RenderSession& session);
    void showUpsampled(uint8_t* rgba, float* depth);
    void enlargeReduced(uint8_t* rgba, float* depth);

    void leaveView(RenderSession& session, const View& view);
    void enterView(const RenderSession& session, const View& view, const RenderProgress& made);
    bool historyCounts(const RenderSession& session) const
    {
        return &session == _imageOf && _history.counts(session.progress().passes);
    }
    bool isStaged(const RenderSession& session) const { return _denoises || historyCounts(session); }

    bool enlarges() const { return _shown == Shown::Mixed || (_shown == Shown::Reduced && _upsamples); }
    const RenderSession& image() const { return _shown == Shown::Whole ? *_session : *_reduced; }

    std::function<double()> _now;
    std::shared_ptr<Workers> _workers;
    std::unique_ptr<RenderSession> _session; ///< full resolution
    std::unique_ptr<RenderSession> _reduced; ///< has no image until one is needed
    Shown _shown = Shown::Whole;
    int _divider = 1; ///< of the reduced image

    // Of the inputs of the last frame
    View _view;
    std::shared_ptr<const TracedScene> _scene;
    RenderOptions _options;
    int _maxPasses = 1;
    int _stillFrames = 0; ///< since any of these changed
    Status _status;

    double _relativeError = std::numeric_limits<double>::infinity();
    int _nextEstimate = 2; ///< passes
    double _estimateSeconds = 0.0;

    // The frame's time
    FramePlanner _planner;
    FrameReport _frame;
    double _begin = 0.0;
    double _deadline = 0.0; ///< for tracing, from _begin on
    double _traceEnd = 0.0;
    int _newTiles = 0;
    Showing _showing = Showing::Whole;
    double _afterSeconds[3] = {}; ///< by _showing: from _traceEnd to noteShown()

    // What the display holds
    ToneMap _toneMap;
    DisplayTarget _display;     ///< of this frame; rgba is null where it cannot be used
    bool _written = false;      ///< the frame's image is in it
    bool _holdsFull = false;    ///< what resolve() would write, and that is of full size
    bool _imageChanged = false; ///< since it was resolved
    std::optional<ToneMap> _resolved;

    // What the session's image is of that made the last one, and what is left of its earlier views.
    bool _reprojects = false;
    const RenderSession* _imageOf = nullptr;
    std::weak_ptr<const TracedScene> _imageScene;
    View _imageView;
    RenderOptions _imageOptions;
    uint32_t _sequence = 0; ///< of random numbers, which is another one for each view that is left
    ViewDependence _viewDependence;
    ViewHistory _history;

    bool _upsamples = false;       ///< there is time to enlarge the reduced image along edges
    double _upsampleSeconds = 0.0; ///< that takes, a pixel

    bool _denoises = false;
    bool _resolvedDenoised = false;
    std::unique_ptr<DenoiseFilter> _denoise;      ///< null until it is needed
    const RenderSession* _surfacesOf = nullptr;   ///< whose image's it knows
    double _denoiseSeconds = 0.0;
};

} // namespace osgRayTrace::engine
