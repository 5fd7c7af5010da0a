// Upsample.h - brings an image of fewer pixels to a view's full size, sharp at edges. Layer:
// session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/session/image/ResolvedImage.h"

#include <limits>

namespace osgRayTrace::engine
{

/// The share that has all pixels traced, those on smooth surfaces, too: nothing thin that lies
/// between the pixels of the image is missed then.
constexpr double kAllTraced = std::numeric_limits<double>::infinity();

/// Sets result to the image at full size. image and samples belong to one view, with row 0 at the
/// bottom and at least one pixel; any size is allowed, but sizes above that of full gain nothing.
/// full is the context of the same view in its full size. All passes of the image looked through
/// the middles of its pixels, see RenderSession::setCentred. The result has no errors.
///
/// If the four pixels of the image around a pixel see one smooth surface of one colour, radiance
/// and window depth are linear between them. Depths of a plane are exact, as they are linear in
/// window space. For all other pixels the pixel's own first hit is traced, in blocks of sixteen.
/// Its radiance is that of the pixels around it whose surface has its plane and normal [Kopf07,
/// sect. 3], over their albedo and times its own. The radiance is L = (a + e) * sum(w_k * L_k) /
/// sum(w_k * (a_k + e)). It is a ratio of sums, so that black pixels of a texture count for little;
/// e keeps it finite if all are black. If no such pixels exist, or all are much darker than the
/// pixel itself, more pixels are looked at, farther away, and the most alike are taken.
///
/// mostTraced is the share of the image beyond which less is traced, as tracing would take more
/// time than the smaller image saves. First only cells at edges themselves are traced, and not
/// cells beside them, although something thin might be there. If these are still too many, only the
/// image's border is traced, and all the rest is linear, depths included. The share is approximate,
/// as it is counted in cells.
///
/// Pictures do not depend on threads. Vectors of result that already have its size are used again.
UpsampleCounts upsample(const ResolvedImage& image, const std::vector<SurfaceSample>& samples,
                        const PassContext& full, double mostTraced, const Workers& workers,
                        ResolvedImage& result);

/// Writes the upsampled image as display values, 4 bytes a pixel, and window depths, which may be
/// null. The work stays in the cache and so costs less than upsample and presentImage.
UpsampleCounts presentUpsampled(const ResolvedImage& image,
                                const std::vector<SurfaceSample>& samples, const PassContext& full,
                                double mostTraced, const ToneMap& toneMap, const Workers& workers,
                                uint8_t* rgba, float* depth);

} // namespace osgRayTrace::engine
