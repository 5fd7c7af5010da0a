// ViewTracer.cpp - the accumulated image of one view, frame after frame. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/ViewTracer.h"

#include "osgRayTrace/bridge/RenderOptionsFromSettings.h"

#include <algorithm>
#include <chrono>
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
    }
    if (!sameButForRounding(pass, _view)) _view = pass;
    _session->setScene(version.scene);
    _session->setView(_view);
    _session->setOptions(renderOptionsFromSettings(*version.settings));

    _denoises = denoises(*version.settings);
    if (_denoises) rgba = nullptr; // that takes the whole image: resolve() does it

    const int passesBefore = _session->progress().passes;
    StopRule rule;
    rule.passes = version.settings->getMaxPasses();
    rule.newPasses = version.settings->getPassesPerFrame();
    const DisplayTarget display{toneMapFromSettings(*version.settings, version.scene->scene()), rgba, depth};
    const RenderProgress made = _session->render(rule, {}, rgba ? &display : nullptr);
    if (made.restarted) _surfacesKnown = false;
    if (!made.status.ok() || (!made.restarted && made.passes == passesBefore)) return false;

    estimateError(rule.passes, made.restarted);
    _imageChanged = !rgba;
    if (rgba)
    {
        _resolved = display.toneMap;
        _resolvedDenoised = false;
    }
    return rgba != nullptr;
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
    _denoises = denoises(*version.settings);
    return hasImage() && (_imageChanged || !_resolved || !same(_toneMap, *_resolved) ||
                          _denoises != _resolvedDenoised);
}

void ViewTracer::resolve(uint8_t* rgba, float* depth)
{
    if (_denoises)
        showImage(denoisedImage(), _toneMap, *_workers, rgba, depth);
    else
        _session->resolveDisplay(_toneMap, rgba, depth);
    _resolved = _toneMap;
    _resolvedDenoised = _denoises;
    _imageChanged = false;
}

std::vector<float> ViewTracer::radiance()
{
    return _denoises ? denoisedImage().radiance : _session->resolveRadiance();
}

ShownImage ViewTracer::denoisedImage()
{
    ShownImage image = _session->shownImage();
    const auto begin = std::chrono::steady_clock::now();
    if (!_denoise) _denoise = std::make_unique<DenoiseFilter>();
    if (!_surfacesKnown)
        _denoise->setSurfaces(_session->surfaceSamples(), image.width, image.height, *_workers);
    _surfacesKnown = true;
    _denoise->filter(image, *_workers);
    _denoiseSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return image;
}

RenderProgress ViewTracer::progress() const
{
    if (!_session) return {};
    RenderProgress progress = _session->progress();
    progress.relativeError = _relativeError;
    progress.denoiseSeconds = _denoiseSeconds;
    return progress;
}

} // namespace osgRayTrace::engine
