// Denoiser.cpp - the denoiser that is asked for, or the one that takes its place. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/Denoiser.h"

namespace osgRayTrace::engine
{

void Denoiser::denoise(ResolvedImage& image, DenoiseKind kind, const Surfaces& surfaces,
                       const Workers& workers)
{
    const ThreadSeam::Entry inside(_seam);
    _report = {};
    if (kind == DenoiseKind::Off) return;
    if (kind == DenoiseKind::Oidn && denoiseByOidn(image, surfaces, workers)) return;
    denoiseByFilter(image, surfaces, workers);
}

/// Returns false if Open Image Denoise cannot be used; the image is then unchanged.
bool Denoiser::denoiseByOidn(ResolvedImage& image, const Surfaces& surfaces, const Workers& workers)
{
    if (!_oidn) _oidn = std::make_unique<DenoiseOidn>();
    if (_oidn->failure().empty())
    {
        if (!_oidnKnows) _oidn->setSurfaces(surfaces(), image.width, image.height, workers);
        _oidnKnows = true;
        _oidn->filter(image, workers);
    }
    if (_oidn->failure().empty())
    {
        _report.by = DenoiseKind::Oidn;
        return true;
    }
    _report.note = "denoise oidn: " + _oidn->failure() + "; denoise filter takes its place";
    return false;
}

void Denoiser::denoiseByFilter(ResolvedImage& image, const Surfaces& surfaces,
                               const Workers& workers)
{
    if (!_filter) _filter = std::make_unique<DenoiseFilter>();
    if (!_filterKnows) _filter->setSurfaces(surfaces(), image.width, image.height, workers);
    _filterKnows = true;
    _filter->filter(image, workers);
    _report.by = DenoiseKind::Filter;
}

} // namespace osgRayTrace::engine
