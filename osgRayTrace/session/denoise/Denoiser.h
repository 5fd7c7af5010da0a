// Denoiser.h - the denoiser that is asked for, or the one that takes its place. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/ThreadSeam.h"
#include "osgRayTrace/session/denoise/DenoiseFilter.h"
#include "osgRayTrace/session/denoise/DenoiseOidn.h"
#include "osgRayTrace/session/denoise/DenoiseReport.h"

#include <functional>
#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// Denoises the images of one view. If Open Image Denoise is not built in or has failed, images go
/// through the filter, and the report says why. The denoiser keeps its arrays from image to image.
/// Only one thread may use a denoiser at a time.
class Denoiser
{
public:
    /// Returns a reference to surfaces that outlive the call.
    using Surfaces = std::function<const std::vector<SurfaceSample>&()>;

    /// Forgets the surfaces, because those of the images to come are different.
    void forgetSurfaces() { _filterKnows = _oidnKnows = false; }

    /// Changes the image's radiance. surfaces is called for the surfaces of the pixels if the
    /// denoiser does not know them. Throws std::bad_alloc, and any exception of surfaces.
    void denoise(ResolvedImage& image, DenoiseKind kind, const Surfaces& surfaces,
                 const Workers& workers);

    const DenoiseReport& report() const { return _report; }

private:
    bool denoiseByOidn(ResolvedImage& image, const Surfaces& surfaces, const Workers& workers);
    void denoiseByFilter(ResolvedImage& image, const Surfaces& surfaces, const Workers& workers);

    // Both are null until they are needed.
    std::unique_ptr<DenoiseFilter> _filter;
    std::unique_ptr<DenoiseOidn> _oidn;
    bool _filterKnows = false, _oidnKnows = false; ///< whether the denoiser has the surfaces
    DenoiseReport _report;
    ThreadSeam _seam;
};

} // namespace osgRayTrace::engine
