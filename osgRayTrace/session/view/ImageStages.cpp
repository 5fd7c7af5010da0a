// ImageStages.cpp - stages of images between accumulation and display. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/ImageStages.h"

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/integrators/shared/IntegratorChoice.h"
#include "osgRayTrace/session/history/SharedChange.h"
#include "osgRayTrace/session/upsample/Upsample.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// The guesses of the time that one thread takes to upsample a pixel, and of the time that a pixel
/// that is traced takes on top, serve until the times are known [s].
constexpr double kUpsampleSeconds = 12e-9, kEdgeSeconds = 30e-9;
/// Views that have all pixels traced go on so while there is time for this share of them, so that
/// what they look like does not change from frame to frame.
constexpr double kKeepsAll = 0.9;
/// Tracing less of an image is not expected to take less than this share of the time.
constexpr double kLeastOfSeen = 0.6;
/// A smaller share of edges does not tell what edges cost.
constexpr double kToldBy = 0.05;
/// While nothing is upsampled, the known time of upsampling shrinks by this factor, so that
/// upsampling will be tried again.
constexpr double kForgets = 0.995;
/// A new measurement that is less than the known value has this weight.
constexpr double kNewWeight = 0.25;

/// Returns the share of the cells that upsampling with this limit takes for edges.
double edgesWithin(const UpsampleCounts& counts, double mostTraced)
{
    if (mostTraced == kAllTraced) return 1.0;
    if (counts.around <= mostTraced) return counts.around;
    return counts.edges <= mostTraced ? counts.edges : 0.0;
}

} // namespace

void ImageStages::reset(std::shared_ptr<Workers> workers)
{
    const ThreadSeam::Entry inside(_seam);
    _workers = std::move(workers);
    _upsampleSeconds = kUpsampleSeconds / _workers->threads();
    _edgeSeconds = kEdgeSeconds / _workers->threads();
    _denoiser.forgetSurfaces();
    _imageScene.reset();
    _history.drop();
    _isKeeping = false;
    _versionsKept = _pause = 0;
}

bool ImageStages::keepView(RenderSession& session, const ImageInputs& next)
{
    const ThreadSeam::Entry inside(_seam);
    constexpr int kPause = 30;
    if (_isKeeping) return true;
    const std::shared_ptr<const TracedScene> before = _imageScene.lock();
    const IntegratorKind integrator = session.progress().integrator;
    const bool samePath =
        integrator == chooseIntegrator(next.options.integrator, next.scene->traits()) &&
        (integrator == IntegratorKind::Path || integrator == IntegratorKind::Whitted);
    const bool hasImage = session.progress().passes > 0 || _history.isKept();
    const bool mayKeep = _mostKept >= 1.0f && before && before != next.scene && hasImage &&
                         samePath && next.view == _imageView &&
                         !next.options.needsRestart(_imageOptions);
    if (!mayKeep || (_pause > 0 && _pause--)) return false;
    const std::shared_ptr<const SceneChange> change = sharedChange(before, next.scene);
    if (!change) return false;
    if (!_history.keep(session, *change, _mostKept, *_workers))
    {
        _pause = kPause;
        return false;
    }
    session.setKeepsSurfaces(true);
    session.setContinuesView(true);
    session.setSequence(_sequence + 1);
    _viewDependence = viewDependence(next.scene->scene());
    _isKeeping = true;
    ++_versionsKept;
    return true;
}

void ImageStages::forgetKept()
{
    const ThreadSeam::Entry inside(_seam);
    _history.drop();
    _isKeeping = false;
    _versionsKept = 0;
    _imageScene.reset();
}

void ImageStages::leaveView(RenderSession& session, const ImageInputs& next)
{
    const ThreadSeam::Entry inside(_seam);
    if (keepView(session, next)) return;
    const bool sameScene = _imageScene.lock() == next.scene;
    const bool rests = sameScene && next.view == _imageView && _history.isKept();
    if (rests && _mostKept > 0.0f && !next.options.needsRestart(_imageOptions)) return;
    if (!rests) _versionsKept = 0;
    session.setContinuesView(false);
    if (_history.isKept() && session.progress().passes == 0) _history.drop();
    if (!sameScene) _viewDependence = viewDependence(next.scene->scene());
    const bool keeps = _reprojects && sameScene && !next.options.needsRestart(_imageOptions) &&
                       !_viewDependence.everywhere &&
                       session.progress().integrator != IntegratorKind::Debug;
    if (!keeps) _history.drop();
    if (keeps && session.progress().passes > 0 && next.view != _imageView)
        _history.leave(session, _imageView, *_workers);

    session.setKeepsSurfaces(_reprojects && !_viewDependence.everywhere);
    if (!keeps) _sequence = 0;
    session.setSequence(_history.leaving() ? _sequence + 1 : 0);
}

void ImageStages::enterView(RenderSession& session, const ImageInputs& next,
                            const RenderProgress& result, const std::function<bool()>& shouldStop)
{
    const ThreadSeam::Entry inside(_seam);
    _freshSeconds = 0.0;
    const bool kept = _isKeeping;
    _isKeeping = false;
    session.setContinuesView(false);
    const bool begun = result.restarted && result.status.ok(); // else the image is the last one
    if (kept && !begun) forgetKept();
    if (result.restarted) _denoiser.forgetSurfaces();
    if (result.restarted && result.status.code != StatusCode::InvalidView)
    {
        _imageScene = next.scene;
        _imageView = next.view;
        _imageOptions = next.options;
        if (_history.leaving() || kept) ++_sequence;
    }
    if (kept && begun) _history.followMoved(session, *_workers);
    // A pass that was given up for its time has none for more samples.
    if (kept && begun && (result.passes > 0 || _history.isWhole(session)))
    {
        const double begin = _now();
        _history.refresh(session, shouldStop, *_workers);
        _freshSeconds = _now() - begin;
    }
    if (_history.leaving() && result.passes > 0 && _imageView == next.view)
        _history.enter(session, next.view, _viewDependence, *_workers);
}

ResolvedImage ImageStages::staged(const RenderSession& session)
{
    ResolvedImage image = session.resolvedImage();
    if (historyCounts(session)) _history.blend(session, image, *_workers);
    if (!denoises()) return image;
    const double begin = _now();
    const auto surfaces = [&session]() -> const std::vector<SurfaceSample>&
    { return session.surfaceSamples(); };
    _denoiser.denoise(image, _denoise, surfaces, *_workers);
    _denoiseSeconds = _now() - begin;
    return image;
}

std::vector<float> ImageStages::radiance(const RenderSession& session)
{
    const ThreadSeam::Entry inside(_seam);
    return changes(session) ? staged(session).radiance : session.resolveRadiance();
}

void ImageStages::show(const RenderSession& session, const ToneMap& toneMap, uint8_t* rgba,
                       float* depth)
{
    const ThreadSeam::Entry inside(_seam);
    _upsampleSeconds *= kForgets;
    forgetEdges();
    if (denoises())
        presentImage(staged(session), toneMap, *_workers, rgba, depth);
    else if (historyCounts(session))
        _history.show(session, toneMap, rgba, depth);
    else
        session.resolveDisplay(toneMap, rgba, depth);
}

/// Shrinks the known time of edges, down to the guess: images without edges do not tell that time.
void ImageStages::forgetEdges()
{
    const double guess = kEdgeSeconds / _workers->threads();
    if (_edgeSeconds > guess) _edgeSeconds = std::max(guess, kForgets * _edgeSeconds);
}

void ImageStages::presentUpsampled(const RenderSession& session, int width, int height,
                                   const DisplayTarget& display, double seconds)
{
    const ThreadSeam::Entry inside(_seam);
    const double pixels = static_cast<double>(width) * height;
    const double plain = kUpsampleSeconds / _workers->threads();
    const double affordable = std::max(0.0, seconds / pixels - plain) / _edgeSeconds;
    const ResolvedImage image = staged(session);
    const double begin = _now();
    _tracesAll = affordable >= (_tracesAll ? kKeepsAll : 1.0);
    const double mostTraced = _tracesAll ? kAllTraced : std::min(1.0, affordable);
    const UpsampleCounts counts = session.presentUpsampled(image, session.surfaceSamples(), width,
                                                           height, display, mostTraced);
    // Something else may have held up this frame: the known time grows by no more than a factor.
    const double seen = (_now() - begin) / pixels;
    const double traced = edgesWithin(counts, mostTraced);
    const double edge = traced > kToldBy ? std::max(0.0, seen - plain) / traced : 0.0;
    if (edge > _edgeSeconds)
        _edgeSeconds += std::min(edge - _edgeSeconds, _edgeSeconds);
    else if (_tracesAll && edge > kEdgeSeconds / _workers->threads())
        _edgeSeconds += kNewWeight * (edge - _edgeSeconds);
    else
        forgetEdges(); // a part of the pixels, or pixels that see nothing, do not tell what all
                       // cost
    // Where there was no time for edges, there may be time for those of fewer pixels; what is
    // traced beyond edges is traced at leisure.
    const double wanted =
        std::max(kLeastOfSeen * seen, seen + (counts.edges - traced) * _edgeSeconds);
    _upsampleSeconds = std::min(wanted, 2.0 * _upsampleSeconds);
}

StageReport ImageStages::report(const RenderSession& session) const
{
    StageReport report;
    report.denoiseSeconds = _denoiseSeconds;
    report.denoised = _denoiser.report();
    report.reprojectedShare = historyCounts(session) ? _history.share() : 0.0;
    report.reprojectSeconds = _history.seconds();
    return report;
}

} // namespace osgRayTrace::engine
