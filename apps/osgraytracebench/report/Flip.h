// Flip.h - the difference that a viewer sees between two pictures [Andersson20]. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace osgRayTrace::bench
{

/// A display 0.7 m wide with 3840 pixels, seen from 0.7 m, has so many pixels per degree.
constexpr double kPixelsPerDegree = 67.0206;

/// Returns FLIP of each pixel, 0 (no difference) to 1, for display values (sRGB encoded, [0,1],
/// three a pixel, rows of width pixels). FLIP is symmetric in the two pictures.
std::vector<float> flip(const std::vector<float>& reference, const std::vector<float>& test,
                        int width, int height, double pixelsPerDegree = kPixelsPerDegree);

/// Returns the mean of FLIP over the pixels.
double meanFlip(const std::vector<float>& reference, const std::vector<float>& test, int width,
                int height);

} // namespace osgRayTrace::bench
