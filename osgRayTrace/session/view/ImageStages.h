// ImageStages.h - stages of a view's images between accumulation and display. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/ThreadSeam.h"
#include "osgRayTrace/session/RenderSession.h"
#include "osgRayTrace/session/denoise/Denoiser.h"
#include "osgRayTrace/session/history/ViewHistory.h"
#include "osgRayTrace/session/view/ViewProgress.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// The inputs are what an image shows, and how the image is traced.
struct ImageInputs
{
    std::shared_ptr<const TracedScene> scene;
    View view;
    RenderOptions options;
};

/// ImageStages applies the history of earlier views, the denoiser and upsampling, in this order,
/// for one session. One thread at a time may use it, and with it the history and the denoiser.
class ImageStages
{
public:
    /// Makes stages without images. now is a clock [s].
    explicit ImageStages(std::function<double()> now) : _now(std::move(now)) {}

    /// Forgets all images: the session is another one, and so are the threads.
    void reset(std::shared_ptr<Workers> workers);

    void setReprojects(bool reprojects) { _reprojects = reprojects; }

    /// Sets how many samples of earlier versions of the scene a pixel may keep; 0: none.
    void setMostKept(float most) { _mostKept = most; }
    void setDenoise(DenoiseKind kind) { _denoise = kind; }
    DenoiseKind denoise() const { return _denoise; }
    bool denoises() const { return _denoise != DenoiseKind::Off; }

    /// These functions are called before and after session.render(): they take what the session's
    /// image is worth to the next image, if nothing but the view changes.
    void leaveView(RenderSession& session, const ImageInputs& next);

    /// Keeps what the session's image is worth to the same view of another version of the scene, if
    /// anything: then the session's next render() is of these inputs. Returns false if the image
    /// has to begin anew.
    bool keepView(RenderSession& session, const ImageInputs& next);

    /// Returns a mark for each tile that has pixels without kept samples.
    const std::vector<uint8_t>& lackingTiles() const { return _history.lackingTiles(); }

    /// Returns how many pixels keep no samples.
    std::size_t lackingPixels() const { return _history.lackingPixels(); }

    /// Gives up what keepView kept.
    void forgetKept();

    /// Returns in how many versions of the scene one after the other samples were kept.
    int versionsKept() const { return _versionsKept; }

    /// shouldStop, which any thread calls, ends the tracing of more samples for pixels that keep
    /// few.
    void enterView(RenderSession& session, const ImageInputs& next, const RenderProgress& result,
                   const std::function<bool()>& shouldStop);

    /// Returns the time that more samples took in the last enterView [s].
    double freshSeconds() const { return _freshSeconds; }

    /// changes() returns true if the image that is shown is not the session's image as it is.
    /// willChange() returns true if that will be so as soon as the image has a whole pass.
    bool changes(const RenderSession& session) const
    {
        return denoises() || historyCounts(session);
    }
    bool willChange() const { return denoises() || _history.leaving(); }

    /// Returns whether the session's image, although it has no whole pass, is whole by what was
    /// kept.
    bool isWhole(const RenderSession& session) const { return _history.isWhole(session); }

    /// These functions give the session's image as it is shown: radiance() returns linear RGBA;
    /// show() writes display values and window depths, of the image's size.
    std::vector<float> radiance(const RenderSession& session);
    void show(const RenderSession& session, const ToneMap& toneMap, uint8_t* rgba, float* depth);

    /// Writes the image at a larger size, which is that of the target. As many pixels of the larger
    /// image are traced as the seconds suffice for, by the times that earlier images took: all of
    /// them, those at edges and beside them, those at edges, or none.
    void presentUpsampled(const RenderSession& session, int width, int height,
                          const DisplayTarget& display, double seconds);

    /// Returns the time that upsampling along all edges takes, by earlier times [s].
    double upsampleSeconds(int width, int height) const
    {
        return _upsampleSeconds * width * height;
    }

    /// Returns what the stages did to the session's image.
    StageReport report(const RenderSession& session) const;

private:
    bool historyCounts(const RenderSession& session) const
    {
        const int passes = session.progress().passes;
        return _history.counts(passes) && (passes > 0 || _history.isWhole(session));
    }
    ResolvedImage staged(const RenderSession& session);
    void forgetEdges();

    ThreadSeam _seam; ///< checks the functions that change the stages
    std::function<double()> _now;
    std::shared_ptr<Workers> _workers;

    // The session's image shows the following; the history is what is left of the image's earlier
    // views.
    bool _reprojects = false;
    std::weak_ptr<const TracedScene> _imageScene;
    View _imageView;
    RenderOptions _imageOptions;
    uint32_t _sequence = 0; ///< sequence of random numbers: each view that is left gets another one
    ViewDependence _viewDependence;
    ViewHistory _history;
    float _mostKept = 0.0f;
    bool _isKeeping = false; ///< true between keepView and enterView
    double _freshSeconds = 0.0;
    int _versionsKept = 0;
    int _pause = 0; ///< versions of the scene for which nothing is tried, as little was kept

    DenoiseKind _denoise = DenoiseKind::Off;
    Denoiser _denoiser;
    double _denoiseSeconds = 0.0;

    double _upsampleSeconds = 0.0; ///< time for a pixel
    double _edgeSeconds = 0.0;     ///< time on top, for a pixel that is traced
    bool _tracesAll = false;       ///< whether all pixels of the last image were traced
};

} // namespace osgRayTrace::engine
