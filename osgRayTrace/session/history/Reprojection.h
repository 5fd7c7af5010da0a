// Reprojection.h - an accumulated image of one view, carried to where its surfaces are in another.
// Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/history/ProjectedRow.h"
#include "osgRayTrace/session/image/SurfaceMap.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Means, and of how many samples they are. Row 0 at the bottom.
struct SampledImage
{
    int width = 0;
    int height = 0;
    std::vector<float> radiance; ///< linear RGBA, premultiplied
    std::vector<float> count;    ///< samples a pixel; 0: nothing is known, radiance is 0
};

/// old, an image of the view of from, as an image of the view of to. A pixel takes the mean of the
/// four old pixels around its surface's place there, bilinear, of those that show the same surface:
/// the same object, near its plane and with its normal. A pixel that borders on no other surface
/// takes nothing from those that do, as they mix both. Away from edges all sixteen around are
/// taken, by Catmull and Rom's cubics [Keys81, eq. 15]: bilinear means of means blur more with each
/// frame. Samples of one pixel are spread over its neighbours with the same weights. Where nothing
/// was hit the image is far away. Not finite values are left out. Returns the share of pixels that
/// took something. result: of another memory than old; reused.
double reproject(const SampledImage& old, const SurfaceMap& from, const SurfaceMap& to,
                 const ReprojectionLimits& limits, const Workers& workers, SampledImage& result);

} // namespace osgRayTrace::engine
