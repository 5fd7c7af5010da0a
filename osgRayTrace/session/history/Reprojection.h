// Reprojection.h - carries an accumulated image of one view to its surfaces' places in another.
// Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/history/ProjectedRow.h"
#include "osgRayTrace/session/image/SurfaceMap.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Holds the means of the pixels, and the number of samples of each mean. Row 0 is at the bottom.
struct SampledImage
{
    int width = 0;
    int height = 0;
    std::vector<float> radiance; ///< linear RGBA, premultiplied
    std::vector<float> count; ///< samples of the pixel; 0: the radiance is not known and set to 0
};

/// Sets result to old, an image of the view of from, as an image of the view of to. A pixel takes
/// the bilinear mean of those of the four old pixels around its surface's place that show the same
/// surface: the same object, near its plane and with its normal. A pixel that borders on no other
/// surface takes nothing from pixels that do, as they mix both surfaces. Away from edges the pixel
/// takes all sixteen pixels around, by the cubics of Catmull and Rom [Keys81, eq. 15], because
/// bilinear means of means blur more with each frame. The samples of one pixel are spread over its
/// neighbours with the same weights. A pixel that hit nothing is treated as infinitely far away.
/// Values that are not finite are left out. Returns the share of pixels that took samples. result
/// must not share memory with old; its arrays are used again.
double reproject(const SampledImage& old, const SurfaceMap& from, const SurfaceMap& to,
                 const ReprojectionLimits& limits, const Workers& workers, SampledImage& result);

} // namespace osgRayTrace::engine
