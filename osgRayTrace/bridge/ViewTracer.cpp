// ViewTracer.cpp - the accumulated image of one view, frame after frame. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/ViewTracer.h"

#include "osgRayTrace/bridge/RenderOptionsFromSettings.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// OSG's culling clamps the planes of last frame's projection matrix again, so that the third
/// column of a view at rest wanders by its last digits; an image must go on nevertheless.
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

bool same(const ToneMap& a, const ToneMap& b)
{
    return a.exposureEv == b.exposureEv && a.displayReferred == b.displayReferred;
}

} // namespace

bool ViewTracer::trace(const SceneVersion& version, const View& pass, uint8_t* rgba, float* depth)
{
    if (_workers != version.workers)
    {
        _session = std::make_unique<RenderSession>(version.workers, version.photons);
        _workers = version.workers;
        _history.drop();
    }
    if (!sameButForRounding(pass, _view)) _view = pass;
    _session->setScene(version.scene);
    _session->setView(_view);
    const RenderOptions options = renderOptionsFromSettings(*version.settings);
    _session->setOptions(options);
    leaveView(version, options);

    const int passesBefore = _session->progress().passes;
    StopRule rule;
    rule.passes = version.settings->getMaxPasses();
    rule.newPasses = version.settings->getPassesPerFrame();
    const DisplayTarget display{toneMapFromSettings(*version.settings, version.scene->scene()), rgba, depth};
    if (_history.leaving() || historyCounts()) rgba = nullptr; // display values need more than the tile's pass
    const RenderProgress made = _session->render(rule, {}, rgba ? &display : nullptr);
    enterView(version, options, made);
    if (!made.status.ok() || (!made.restarted && made.passes == passesBefore)) return false;

    estimateError(rule.passes, made.restarted);
    _imageChanged = !rgba;
    if (rgba) _resolved = display.toneMap;
    return rgba != nullptr;
}

/// Takes what the session's image is worth to the next one, if nothing but the view changes.
void ViewTracer::leaveView(const SceneVersion& version, const RenderOptions& options)
{
    const bool sameScene = _imageScene.lock() == version.scene;
    const bool sameSize = _view.width == _imageView.width && _view.height == _imageView.height;
    if (!sameScene) _viewDependence = viewDependence(version.scene->scene());
    const bool keeps = version.settings->getReproject() && sameScene && sameSize &&
                       !options.needsRestart(_imageOptions) && !_viewDependence.everywhere &&
                       _session->progress().integrator != IntegratorKind::Debug;
    if (!keeps) _history.drop();
    if (keeps && hasImage() && _view != _imageView) _history.leave(*_session, _imageView, *_workers);

    if (!keeps) _sequence = 0;
    _session->setSequence(_history.leaving() ? _sequence + 1 : 0);
}

void ViewTracer::enterView(const SceneVersion& version, const RenderOptions& options,
                           const RenderProgress& made)
{
    if (made.restarted && made.status.code != StatusCode::InvalidView)
    {
        _imageScene = version.scene;
        _imageView = _view;
        _imageOptions = options;
        if (_history.leaving()) ++_sequence;
    }
    if (_history.leaving() && made.passes > 0 && _imageView == _view)
        _history.enter(*_session, _view, _viewDependence, *_workers);
}

ShownImage ViewTracer::blendedImage() const
{
    ShownImage image = _session->shownImage();
    _history.blend(image, _session->progress().passes, *_workers);
    return image;
}

std::vector<float> ViewTracer::radiance() const
{
    return historyCounts() ? blendedImage().radiance : _session->resolveRadiance();
}

void ViewTracer::estimateError(int maxPasses, bool restarted)
{
    if (restarted)
    {
        _relativeError = std::numeric_limits<double>::infinity();
        _nextEstimate = 2;
    }
    const int passes = _session->progress().passes;
    if (passes < 2 || (passes < _nextEstimate && passes < maxPasses)) return;
    _relativeError = _session->estimateRelativeError();
    _nextEstimate = passes + std::max(1, passes / 8);
}

bool ViewTracer::needsResolve(const SceneVersion& version)
{
    _toneMap = toneMapFromSettings(*version.settings, version.scene->scene());
    return hasImage() && (_imageChanged || !_resolved || !same(_toneMap, *_resolved));
}

void ViewTracer::resolve(uint8_t* rgba, float* depth)
{
    if (historyCounts())
        showImage(blendedImage(), _toneMap, *_workers, rgba, depth);
    else
        _session->resolveDisplay(_toneMap, rgba, depth);
    _resolved = _toneMap;
    _imageChanged = false;
}

RenderProgress ViewTracer::progress() const
{
    if (!_session) return {};
    RenderProgress progress = _session->progress();
    progress.relativeError = _relativeError;
    progress.reprojectedShare = historyCounts() ? _history.share() : 0.0;
    progress.reprojectSeconds = _history.seconds();
    return progress;
}

} // namespace osgRayTrace::engine
