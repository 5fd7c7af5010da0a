// ViewTracerDisplay.cpp - the image of a view as the display gets it. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/ViewTracer.h"

#include "osgRayTrace/film/Enlarge.h"

#include <algorithm>

namespace osgRayTrace::engine
{

bool ViewTracer::needsResolve(const ViewInputs& inputs)
{
    const ThreadSeam::Entry inside(_seam);
    if (inputs.autoExposure) meter();
    _toneMap = shownBy(inputs);
    setDenoise(inputs.denoise);
    return hasImage() && (_imageChanged || !_resolved || _toneMap != *_resolved ||
                          _stages.denoise() != _resolvedDenoise);
}

/// Reads the exposure of the image, and has the display follow it.
void ViewTracer::meter()
{
    constexpr int kMostTiles = 256; // some 0.1 ms
    if (!hasImage()) return;
    const std::optional<float> reading = image().meteredEv(kMostTiles);
    if (reading)
        _autoEv = _exposure.follow(*reading);
    else
        _exposure.rest();
}

/// Views that agree show one picture, and keep the exposure that is set.
ToneMap ViewTracer::shownBy(const ViewInputs& inputs)
{
    ToneMap toneMap = toneMapOf(inputs);
    if (!inputs.autoExposure) _exposure.reset();
    if (!inputs.autoExposure || _agreement) _autoEv = 0.0f;
    toneMap.exposureEv += _autoEv;
    return toneMap;
}

void ViewTracer::resolve(uint8_t* rgba, float* depth)
{
    const ThreadSeam::Entry inside(_seam);
    switch (_displayState)
    {
    case DisplayState::Whole:
        _stages.show(*_session, _toneMap, rgba, depth);
        break;
    case DisplayState::Reduced:
        presentReduced(displayDivider(), rgba, depth);
        break;
    case DisplayState::Mixed:
        // Single tiles cannot be denoised: tiles of full resolution then wait until all are there.
        enlargeReduced(rgba, depth);
        if (!denoises()) _session->resolveOver(_toneMap, rgba, depth);
        break;
    }
    _holdsFull = _displayState == DisplayState::Reduced ? displayDivider() == 1 && !denoises()
                                                        : !stagesOf(image()).changes(image());
    _resolved = _toneMap;
    _resolvedDenoise = _stages.denoise();
    _imageChanged = false;
}

std::vector<float> ViewTracer::radiance()
{
    const ThreadSeam::Entry inside(_seam);
    return stagesOf(image()).radiance(image());
}

/// Writes the reduced image, upsampled along edges if the divider is less than that of the image.
void ViewTracer::presentReduced(int divider, uint8_t* rgba, float* depth)
{
    if (divider == _divider)
        _reducedStages.show(*_reduced, _toneMap, rgba, depth);
    else
        _reducedStages.presentUpsampled(*_reduced, reducedSize(_view.width, divider),
                                        reducedSize(_view.height, divider), {_toneMap, rgba, depth},
                                        _upsampleBudget);
}

/// Writes the reduced image at full resolution: the image is upsampled along edges as far as there
/// is time, then enlarged from nothing but its pixels.
void ViewTracer::enlargeReduced(uint8_t* rgba, float* depth)
{
    const int divider = std::min(_upsampleDivider, _divider);
    if (divider == 1) return presentReduced(1, rgba, depth);
    const int width = reducedSize(_view.width, divider),
              height = reducedSize(_view.height, divider);
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<uint8_t> smallRgba(4 * pixels);
    std::vector<float> smallDepth(pixels);
    presentReduced(divider, smallRgba.data(), smallDepth.data());
    const DisplayPixels small{width, height, smallRgba.data(), smallDepth.data()};
    const DisplayPixels large{_view.width, _view.height, rgba, depth};
    enlarge(small, large, *_workers);
}

void ViewTracer::forgetDisplay()
{
    const ThreadSeam::Entry inside(_seam);
    _holdsFull = false;
    _resolved.reset();
}

void ViewTracer::forget()
{
    const ThreadSeam::Entry inside(_seam);
    if (!_workers) return;
    _stages.reset(_workers);
    _reducedStages.reset(_workers);
    _workers.reset();
    _session.reset();
    _reduced.reset();
    _scene.reset();
    _displayState = DisplayState::Whole;
    _status = {};
    _holdsFull = false;
    _resolved.reset();
}

} // namespace osgRayTrace::engine
