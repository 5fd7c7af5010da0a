// PassSums.h - the sums of some passes of an image, to keep, send and add. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/film/PassSet.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds what an exact film holds, in rows of pixels. Equal sums of equal passes are equal, bit by
/// bit, in whatever parts and order they were made.
struct PassSums
{
    int width = 0, height = 0;
    PassSet passes;
    /// Sums in units of 2^-40, by half (even passes, odd ones), channel (R, G, B, A) and pixel, row
    /// 0 at the bottom: ExactSum::low.
    std::vector<int64_t> low;
    std::vector<int64_t> high; ///< the same in units of 2^-12: ExactSum::high; empty: all are 0
    std::vector<float> depth;  ///< window depths of the first of the passes

    static constexpr std::size_t kPlanes = 8; ///< halves times channels

    std::size_t pixels() const
    {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
};

/// Returns the sums of a film whose tiles all have these passes.
PassSums sumsOf(const Film& film, const PassSet& passes);

/// Makes the film that of the sums.
void setFilm(const PassSums& sums, Film& film);

/// Gives sums that come from elsewhere the members that equal sums have.
void normalise(PassSums& sums);

/// Adds other passes of the same image. The sets have no pass in common, and the sizes are equal.
void addSums(const PassSums& from, PassSums& into);

} // namespace osgRayTrace::engine
