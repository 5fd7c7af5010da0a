// PictureError.h - relMSE of one picture, with and without its worst pixels. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Reference.h"

#include <vector>

namespace osgRayTrace::bench
{

/// Holds mean((x - r)^2 / (r^2 + e^2)) less the reference's own variance; e is 1 % of the
/// reference's mean luminance.
struct PictureError
{
    double relMse = 0.0;
    /// relMSE of all pixels but the worst 0.1 %, at least one: those hold most of the error of
    /// caustics and small openings, and are others in each picture.
    double trimmed = 0.0;
};

PictureError pictureError(const Pixels& pixels, const Reference& reference);

/// Holds the median of figures that pictures with independent seeds have.
struct SeedMedian
{
    double value = 0.0;
    double spread = 1.0; ///< largest figure over the smallest
    /// The medians of two such sets of pictures differ by less than this factor in 95 of 100
    /// cases, if logarithms of the figures are normally distributed.
    double agreement = 1.0;
};

/// values: two or more. Values of zero and below, which noise of the reference can make, count as
/// the smallest value above zero.
SeedMedian medianOfSeeds(std::vector<double> values);

} // namespace osgRayTrace::bench
