// ViewTracer.h - the accumulated image of one view, frame after frame. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/SceneUpdater.h"
#include "osgRayTrace/session/DenoiseFilter.h"
#include "osgRayTrace/session/RenderSession.h"

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
    std::vector<float> radiance();

    /// Of the image. The error estimate is renewed when the passes have grown by an eighth: it
    /// costs as much as a resolve.
    RenderProgress progress() const;

private:
    void estimateError(int maxPasses, bool restarted);
    ShownImage denoisedImage();

    std::shared_ptr<Workers> _workers;
    std::unique_ptr<RenderSession> _session;
    View _view;
    double _relativeError = std::numeric_limits<double>::infinity();
    int _nextEstimate = 2; ///< passes

    ToneMap _toneMap;
    bool _imageChanged = false; ///< since it was resolved
    std::optional<ToneMap> _resolved;

    bool _denoises = false;
    bool _resolvedDenoised = false;
    std::unique_ptr<DenoiseFilter> _denoise; ///< null until it is needed
    bool _surfacesKnown = false;             ///< to it, of the present view and scene
    double _denoiseSeconds = 0.0;
};

} // namespace osgRayTrace::engine
