// ResolvedImage.h - a view's image on its way to the display, if stages work on it. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/integrators/shared/SurfaceSample.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;

/// Holds the pixels in rows; row 0 is at the bottom.
struct ResolvedImage
{
    int width = 0;
    int height = 0;
    std::vector<float> radiance; ///< linear RGBA, premultiplied
    std::vector<float> error;    ///< standard error of the mean, linear RGB; empty below two passes
    std::vector<float> depth;    ///< window depth
};

/// Counts the work of making a full-size image of a smaller one, see Upsample.h.
struct UpsampleCounts
{
    uint64_t traced = 0; ///< pixels of the full size whose first hit was traced
    uint64_t unlike = 0; ///< traced pixels whose surface none of the four pixels around them sees
    double edges = 0.0;  ///< share of the small image's cells that are at edges
    /// Share of the cells at edges or beside them, which would be traced without a limit.
    double around = 0.0;
};

/// Writes the display values of the image, 4 bytes a pixel, and its depths, which may be null.
void presentImage(const ResolvedImage& image, const ToneMap& toneMap, const Workers& workers,
                  uint8_t* rgba, float* depth);

} // namespace osgRayTrace::engine
