// ErrorEstimate.h - how far the accumulated image is from the converged one. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/film/KernelBias.h"

#include <limits>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;

/// The estimate is infinite below two passes. x is the image, r the converged one, and R the mean
/// of r over the pixels of a tile, channel by channel.
struct ErrorEstimate
{
    /// sqrt(mean((x - r)^2 / (R^2 + 0.01))) over pixels and RGB, noise and the bias of photon
    /// look-ups. R is not known but taken from x;
    /// the tile has so many samples that this matters only if errors are greater than visible ones.
    /// A pixel's own r, or that of a block of 4 x 4, would be as noisy as the error at a light's
    /// edge, and hide most of the error.
    double relative = std::numeric_limits<double>::infinity();
    /// The median over tiles with an error of sqrt(mean((x - r)^2 / (max(r, R)^2 + 0.01))): the
    /// error of most of the image, whatever a few pixels do.
    double median = std::numeric_limits<double>::infinity();
    /// The share of the sum behind relative that the worst thousandth of the pixels holds, in
    /// [0,1]; a pixel at least.
    double worstShare = 0.0;
};

/// Holds the bias that pixels have seen in discs, by tile; empty if none has compared any. The
/// parts are judged one by one, and so neither hides the other.
struct FootprintBiases
{
    std::vector<FootprintBias> compared; ///< the part of the passes that were compared
    std::vector<FootprintBias> later;    ///< that of later ones, in pixels that still take discs
};

/// Returns the estimate for the whole image, from its two halves [Rousselle12, sect. 3].
/// differences: by tile, or empty if no photons were looked up. The bias is the larger one that
/// differences and footprints tell.
ErrorEstimate estimateError(const Film& film, const Workers& workers,
                            const std::vector<DiscDifferences>& differences = {},
                            const FootprintBiases& footprints = {});

} // namespace osgRayTrace::engine
