// ImageStages.h - what is done to a view's images between accumulation and display. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/RenderSession.h"
#include "osgRayTrace/session/denoise/Denoiser.h"
#include "osgRayTrace/session/history/ViewHistory.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// What an image is of.
struct ImageInputs
{
    std::shared_ptr<const TracedScene> scene;
    View view;
    RenderOptions options;
};

/// The history of earlier views, the denoiser and upsampling, in this order, for one session. One
/// thread at a time.
class ImageStages
{
public:
    /// now: a clock [s].
    explicit ImageStages(std::function<double()> now) : _now(std::move(now)) {}

    /// Forgets all images: the session is another one, and so are the threads.
    void reset(std::shared_ptr<Workers> workers);

    void setReprojects(bool reprojects) { _reprojects = reprojects; }
    void setDenoise(DenoiseKind kind) { _denoise = kind; }
    DenoiseKind denoise() const { return _denoise; }
    bool denoises() const { return _denoise != DenoiseKind::Off; }

    /// Before and after session.render(): takes what its image is worth to the next one, if nothing
    /// but the view changes.
    void leaveView(RenderSession& session, const ImageInputs& next);
    void enterView(RenderSession& session, const ImageInputs& next, const RenderProgress& result);

    /// True if what is shown is not the session's image as it is; and if it will not be as soon as
    /// that has a whole pass.
    bool changes(const RenderSession& session) const
    {
        return denoises() || historyCounts(session);
    }
    bool willChange() const { return denoises() || _history.leaving(); }

    /// The session's image as it is shown: linear RGBA, or display values and window depths of its
    /// size.
    std::vector<float> radiance(const RenderSession& session);
    void show(const RenderSession& session, const ToneMap& toneMap, uint8_t* rgba, float* depth);

    /// The image at a larger size, along the edges of what is seen as far as the seconds go, which
    /// earlier times tell; a target of that size.
    void presentUpsampled(const RenderSession& session, int width, int height,
                          const DisplayTarget& display, double seconds);

    /// Of the pixels of a reduced image, those that may be traced to upsample it.
    static constexpr double kMostTraced = 0.25;

    /// What upsampling takes with all edges that are worth it, going by the times before [s].
    double upsampleSeconds(int width, int height) const
    {
        return _upsampleSeconds * width * height;
    }

    /// What the stages did to the session's image.
    void report(const RenderSession& session, RenderProgress& progress) const;

private:
    bool historyCounts(const RenderSession& session) const
    {
        const int passes = session.progress().passes;
        return passes > 0 && _history.counts(passes);
    }
    ResolvedImage staged(const RenderSession& session);
    void forgetEdges();

    std::function<double()> _now;
    std::shared_ptr<Workers> _workers;

    // What the session's image is of, and what is left of its earlier views.
    bool _reprojects = false;
    std::weak_ptr<const TracedScene> _imageScene;
    View _imageView;
    RenderOptions _imageOptions;
    uint32_t _sequence = 0; ///< of random numbers, which is another one for each view that is left
    ViewDependence _viewDependence;
    ViewHistory _history;

    DenoiseKind _denoise = DenoiseKind::Off;
    Denoiser _denoiser;
    double _denoiseSeconds = 0.0;

    double _upsampleSeconds = 0.0; ///< a pixel
    double _edgeSeconds = 0.0;     ///< more, one in a cell at an edge
};

} // namespace osgRayTrace::engine
