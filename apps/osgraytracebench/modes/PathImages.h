// PathImages.h - error and cost of images by path tracing, without a reference. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"
#include "apps/osgraytracebench/scenes/BenchScenes.h"

namespace osgRayTrace::bench
{

constexpr int kImagePasses = 16;

struct ImageFigures
{
    double seconds = 0.0; ///< of one thread, for the passes of an image
    double error = 0.0;   ///< relative mean square error of one image
    double product = 0.0; ///< error x seconds, for 512 x 512 pixels and two threads
};

/// Renders images of kImagePasses passes in pairs of independent ones, and adds the rows of their
/// error and cost. An error is relative to the mean of 17 x 17 pixels around a pixel, or to a tenth
/// of the image's mean if that is more; the worst thousandth of the pixels is left out. goal: bound
/// of the product; 0: none.
ImageFigures measureImage(const std::string& name, const BenchScene& bench, double goal, Rows& rows,
                          int pairs = 1);

} // namespace osgRayTrace::bench
