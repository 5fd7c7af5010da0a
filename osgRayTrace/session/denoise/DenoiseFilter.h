// DenoiseFilter.h - takes noise out of an image of few samples, along the edges of what is seen.
// Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/image/ResolvedImage.h"

#include <memory>

namespace osgRayTrace::engine
{

/// An edge-avoiding a-trous filter [Dammertz10] guided by variance [Schied17], on light over
/// albedo. It works on cells of 2 x 2 pixels, from which each pixel takes its light by how alike
/// their surfaces are.
///
/// With F the light so filtered, D that of the image, V the mean square of the image's standard
/// error and S that of D - F, both over a small neighbourhood:
///
///     result = albedo alpha (F + k (D - F)),   k = max(0, 1 - c V/S),   c = 1.25
///
/// F is taken as far as the image's noise explains how it differs from D. The mean square of what
/// is changed, S (1 - k)^2, is S or (c V)^2/S, whichever is smaller, and never more than c V: the
/// filter vanishes as the image converges. An image of one pass has no errors: they are estimated
/// from its neighbourhood, and k is 0.
///
/// Lamps, mirrors, clear glass, the background and values that are not finite stay as they are, bit
/// for bit. The result does not depend on the number of threads. Keeps its arrays from image to
/// image. One thread at a time.
class DenoiseFilter
{
public:
    DenoiseFilter();
    ~DenoiseFilter();

    /// What is seen in the pixels of the images to come. Throws std::bad_alloc.
    void setSurfaces(const std::vector<SurfaceSample>& surfaces, int width, int height,
                     const Workers& workers);

    /// Changes the image's radiance; its errors are then not its own any more and stay as they are.
    /// Does nothing to an image of another size than that of the surfaces.
    void filter(ResolvedImage& image, const Workers& workers);

private:
    struct Implementation;
    std::unique_ptr<Implementation> _implementation;
};

} // namespace osgRayTrace::engine
