// ExactSums.h - sums of radiance that have no order. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/LargeArray.h"
#include "osgRayTrace/film/TileLayout.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds a sum of floats as a fixed-point number, so that it does not depend on the order in which
/// they were added: low * 2^-40 + high * 2^-12. Sums of magnitude below 2^21 have high = 0, so that
/// equal sums have equal members.
struct ExactSum
{
    int64_t low = 0;
    int64_t high = 0;

    bool operator==(const ExactSum& o) const { return low == o.low && high == o.high; }
};

/// Returns the sum of both parts of both; each of magnitude below 2^62, whether or not high is 0.
ExactSum added(const ExactSum& a, const ExactSum& b);

/// Returns the mean of count values, rounded once.
inline float meanOf(const ExactSum& sum, int count)
{
    const double value =
        static_cast<double>(sum.low) * 0x1p-40 + static_cast<double>(sum.high) * 0x1p-12;
    return static_cast<float>(value / count);
}

/// Holds the sums of both halves of an image's passes, tile by tile. A value of magnitude below
/// 2^11 is rounded to a multiple of 2^-40; that loses nothing from 2^-17 on, as floats are coarser
/// there. Larger values have all bits. Different threads may add to different tiles.
class ExactSums
{
public:
    static constexpr std::size_t kValues = 4 * kTilePixels; ///< of a tile, as in RgbaLanes

    ExactSums() = default;
    explicit ExactSums(std::size_t tiles);

    bool empty() const { return _low.size() == 0; }

    /// Adds a pass of a tile to a half that has so many passes already. Values that are not finite,
    /// or of magnitude 2^40 and more, are left out; returns how many these are.
    int add(std::size_t tile, int half, int passes, const RgbaLanes* values);

    /// Returns the sum of value i of a tile; the half has a pass.
    ExactSum sum(std::size_t tile, int half, std::size_t i) const;

    /// Writes the means of count passes of a half, or of both halves together, for all values of a
    /// tile: meanOf() of their sums.
    void means(std::size_t tile, int half, int count, float* values) const;
    void means(std::size_t tile, int count, float* values) const;

    /// Replaces the sum of a value.
    void set(std::size_t tile, int half, std::size_t i, const ExactSum& sum);

private:
    static std::size_t index(std::size_t tile, int half)
    {
        return tile * 2 + static_cast<std::size_t>(half);
    }
    uint64_t* low(std::size_t tile, int half) { return &_low[index(tile, half) * kValues]; }
    std::vector<int64_t>& largeOf(std::size_t tile, int half);
    void carry(std::size_t tile, int half);

    UnclearedArray<uint64_t> _low; ///< [2^-40], by tile, half, value: the sum and the half's shift
    /// What each value of a half has beside its sum, modulo 2^64, by tile, half: what rounds a
    /// value to an integer is left in, as taking it out of each value would be a seventh of the
    /// cost.
    std::vector<uint64_t> _shifts;
    std::vector<std::vector<int64_t>> _high; ///< [2^-12], by tile, half; empty: all are 0
};

} // namespace osgRayTrace::engine
