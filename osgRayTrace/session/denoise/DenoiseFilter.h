// DenoiseFilter.h - takes noise out of an image of few samples, along the edges of surfaces. Layer:
// session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/image/ResolvedImage.h"

#include <memory>

namespace osgRayTrace::engine
{

/// Filters light over albedo by an edge-avoiding a-trous filter [Dammertz10] guided by variance
/// [Schied17]. The filter works on cells of 2 x 2 pixels, from which each pixel takes its light by
/// how alike their surfaces are.
///
/// F is the filtered light and D the light of the image. V is the mean square of the image's
/// standard error and S the mean square of D - F, both over a small neighbourhood.
///
///     result = albedo alpha (F + k (D - F)),   k = max(0, 1 - c V/S),   c = 1.25
///
/// F is taken as far as the image's noise explains how F differs from D. The mean square of the
/// change, S (1 - k)^2, is S or (c V)^2/S, whichever is smaller, and never more than c V: the
/// filter vanishes as the image converges. An image of one pass has no errors: its errors are
/// estimated from the neighbourhood, and k is 0.
///
/// Lamps, mirrors, clear glass, the background and values that are not finite stay as they are, bit
/// for bit. The result does not depend on the number of threads. The filter keeps its arrays from
/// image to image. Only one thread may use a filter at a time.
class DenoiseFilter
{
public:
    DenoiseFilter();
    ~DenoiseFilter();

    /// Sets the surfaces that the pixels of the images to come show. Throws std::bad_alloc.
    void setSurfaces(const std::vector<SurfaceSample>& surfaces, int width, int height,
                     const Workers& workers);

    /// Changes the image's radiance. The image's errors, which no longer belong to that radiance,
    /// stay as they are. An image of another size than that of the surfaces stays as it is.
    void filter(ResolvedImage& image, const Workers& workers);

private:
    struct Implementation;
    std::unique_ptr<Implementation> _implementation;
};

} // namespace osgRayTrace::engine
