// Flip.h - the difference that a viewer sees between two pictures shown in turn [Andersson20].
// Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace osgRayTrace::bench
{

/// Of a display 0.7 m wide with 3840 pixels, seen from 0.7 m.
constexpr double kPixelsPerDegree = 67.0206;

/// FLIP of each pixel, 0 (the same) to 1, for display values (sRGB encoded, [0,1], three a pixel,
/// rows of width pixels). Symmetric in the two pictures.
std::vector<float> flip(const std::vector<float>& reference, const std::vector<float>& test,
                        int width, int height, double pixelsPerDegree = kPixelsPerDegree);

/// Its mean over the pixels.
double meanFlip(const std::vector<float>& reference, const std::vector<float>& test, int width,
                int height);

} // namespace osgRayTrace::bench
