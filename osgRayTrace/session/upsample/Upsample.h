// Upsample.h - an image of fewer pixels at a view's full size, sharp at edges. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/session/image/ResolvedImage.h"

namespace osgRayTrace::engine
{

/// image and samples: of one view, row 0 at the bottom, at least one pixel; any size, but sizes
/// above that of full gain nothing. full: of the same view in its full size. The result has no
/// errors.
///
/// Where the four pixels of the image around a pixel see one smooth surface of one colour, radiance
/// and window depth are linear between them: depths of a plane are exact, as they are linear in
/// window space. Elsewhere the pixel's own first hit is traced, in blocks of sixteen. Its radiance
/// is that of the pixels around it whose surface has its plane and normal [Kopf07, sect. 3], over
/// their albedo and times its own:
///     L = (a + e) * sum(w_k * L_k) / sum(w_k * (a_k + e)),
/// a ratio of sums, so that black pixels of a texture count for little in it; e keeps it finite
/// where all are black. If there are no such pixels, or all are much darker than the pixel itself,
/// more of them are looked at, farther away, and the most alike taken.
///
/// mostTraced: share of the image beyond which less is traced, as it would take more time than the
/// image was to save: first only what is at edges itself, and not beside them, where something thin
/// might be; then nothing but the image's border, and all is linear, depths included. About that:
/// it is counted in cells.
///
/// Pictures do not depend on threads. Vectors of result that have its size already are used again.
UpsampleCounts upsample(const ResolvedImage& image, const std::vector<SurfaceSample>& samples,
                        const PassContext& full, double mostTraced, const Workers& workers,
                        ResolvedImage& result);

/// The same as display values, 4 bytes a pixel, and window depths, which may be null: in the cache,
/// and so for less than upsample and presentImage.
UpsampleCounts presentUpsampled(const ResolvedImage& image,
                                const std::vector<SurfaceSample>& samples, const PassContext& full,
                                double mostTraced, const ToneMap& toneMap, const Workers& workers,
                                uint8_t* rgba, float* depth);

} // namespace osgRayTrace::engine
