// ViewTracer.h - the accumulated image of one view, frame after frame. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/SceneUpdater.h"
#include "osgRayTrace/session/RenderSession.h"
#include "osgRayTrace/session/ViewHistory.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

/// A RenderSession under OSG: takes a frame's matrices and settings, and knows when there is
/// something new to show. One thread at a time.
class ViewTracer
{
public:
    /// Traces the settings' passes of a frame, if the image needs any. Failures are in progress(),
    /// the image stays. Throws std::bad_alloc only.
    /// If rgba is not null it takes display values and depth of a new image as resolve() would write
    /// them, for less: buffers of the pass's size. True if it did.
    bool trace(const SceneVersion& version, const View& pass, uint8_t* rgba = nullptr,
               float* depth = nullptr);

    /// Takes the settings of how the image is shown. True if the image, or that, differs from what
    /// was resolved last. False if there is no image.
    bool needsResolve(const SceneVersion& version);

    /// Display values and window depths, width() * height() pixels.
    void resolve(uint8_t* rgba, float* depth);

    bool hasImage() const
    {
        return _session && _session->width() > 0 && _session->progress().passes > 0;
    }
    int width() const { return _session->width(); }
    int height() const { return _session->height(); }
    /// Linear RGBA of what is shown.
    std::vector<float> radiance() const;

    /// Of the image. The error estimate is renewed when the passes have grown by an eighth: it
    /// costs as much as a resolve, and is that of the session's film alone.
    RenderProgress progress() const;

private:
    void estimateError(int maxPasses, bool restarted);
    void leaveView(const SceneVersion& version, const RenderOptions& options);
    void enterView(const SceneVersion& version, const RenderOptions& options, const RenderProgress& made);
    ShownImage blendedImage() const;
    bool historyCounts() const { return _history.counts(_session->progress().passes); }

    std::shared_ptr<Workers> _workers;
    std::unique_ptr<RenderSession> _session;
    View _view;
    double _relativeError = std::numeric_limits<double>::infinity();
    int _nextEstimate = 2; ///< passes

    ToneMap _toneMap;
    // What the session's image is of, and what is left of its earlier views.
    std::weak_ptr<const TracedScene> _imageScene;
    View _imageView;
    RenderOptions _imageOptions;
    uint32_t _sequence = 0; ///< of random numbers, which is another one for each view that is left
    ViewDependence _viewDependence;
    ViewHistory _history;

    bool _imageChanged = false; ///< since it was resolved
    std::optional<ToneMap> _resolved;
};

} // namespace osgRayTrace::engine
