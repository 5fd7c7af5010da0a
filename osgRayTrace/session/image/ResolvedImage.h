// ResolvedImage.h - a view's image on its way to the display, where more is done to it than a tone
// map. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/integrators/shared/SurfaceSample.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;

/// Pixels in rows, row 0 at the bottom.
struct ResolvedImage
{
    int width = 0;
    int height = 0;
    std::vector<float> radiance; ///< linear RGBA, premultiplied
    std::vector<float> error;    ///< standard error of the mean, linear RGB; empty below two passes
    std::vector<float> depth;    ///< window depth
};

/// What it took to make a full-size image of one of fewer pixels, see Upsample.h.
struct UpsampleCounts
{
    uint64_t traced = 0; ///< pixels of the full size whose first hit was traced
    uint64_t unlike = 0; ///< of these: whose surface none of the four pixels around it sees
    double edges = 0.0;  ///< share of the small image's cells that are at edges,
    double around =
        0.0; ///< and that are at edges or beside them: what would be traced without a limit
};

/// Display values of the image, 4 bytes a pixel, and its depths, which may be null.
void presentImage(const ResolvedImage& image, const ToneMap& toneMap, const Workers& workers,
                  uint8_t* rgba, float* depth);

} // namespace osgRayTrace::engine
