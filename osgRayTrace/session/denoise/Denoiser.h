// Denoiser.h - the denoiser that is asked for, or the one that takes its place. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/denoise/DenoiseFilter.h"
#include "osgRayTrace/session/denoise/DenoiseOidn.h"
#include "osgRayTrace/session/denoise/DenoiseReport.h"

#include <functional>
#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// For the images of one view. Where Open Image Denoise is not built in, or has failed, images go
/// through the filter, and the report says why. Keeps its arrays from image to image. One thread at
/// a time.
class Denoiser
{
public:
    using Surfaces =
        std::function<const std::vector<SurfaceSample>&()>; ///< of something that stays

    /// What is seen in the pixels of the images to come is not what it was.
    void forgetSurfaces() { _filterKnows = _oidnKnows = false; }

    /// Changes the image's radiance; surfaces is asked for what is seen in its pixels if that is
    /// not known. Throws std::bad_alloc, and what surfaces throws.
    void denoise(ResolvedImage& image, DenoiseKind kind, const Surfaces& surfaces,
                 const Workers& workers);

    const DenoiseReport& report() const { return _report; }

private:
    bool denoiseByOidn(ResolvedImage& image, const Surfaces& surfaces, const Workers& workers);
    void denoiseByFilter(ResolvedImage& image, const Surfaces& surfaces, const Workers& workers);

    // Null until they are needed.
    std::unique_ptr<DenoiseFilter> _filter;
    std::unique_ptr<DenoiseOidn> _oidn;
    bool _filterKnows = false, _oidnKnows = false; ///< what is seen in the pixels
    DenoiseReport _report;
};

} // namespace osgRayTrace::engine
