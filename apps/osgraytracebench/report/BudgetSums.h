// BudgetSums.h - the errors of the pictures that reached one budget. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Reference.h"
#include "apps/osgraytracebench/report/Report.h"
#include "apps/osgraytracebench/report/Slopes.h"

namespace osgRayTrace::bench
{

/// Holds the figures of one picture beside its pixels.
struct PictureCost
{
    double seconds = 0.0;
    double passes = 0.0;
    double rays = 0.0;
    int64_t dropped = 0;
    bool wantsFlip = false; ///< FLIP costs time: the first seeds are enough
};

class BudgetSums
{
public:
    explicit BudgetSums(const Reference& reference);

    void add(const Pixels& pixels, const PictureCost& cost);

    /// Returns the relMSE of picture number seed, less the reference's own variance.
    double relMse(std::size_t seed) const { return _relMse[seed]; }
    double seconds(std::size_t seed) const { return _seconds[seed]; }
    double passes(std::size_t seed) const { return _passes[seed]; }
    std::size_t seeds() const { return _relMse.size(); }

    /// Returns a row without budget and samples. The pixels of a picture count as independent of
    /// each other.
    ReportRow row() const;

private:
    void addBias(ReportRow& row) const;

    const Reference& _reference;
    std::vector<double> _difference, _squares; ///< sums over pictures, by pixel and colour
    std::vector<double> _pixelSquares; ///< sums of the squared sum over the colours, by pixel
    std::vector<double> _seconds, _passes, _rays, _relMse, _relMseFixed, _mse, _percentile, _flip;
    int64_t _nonFinite = 0;
    double _relativeNoise = 0.0; ///< part of relMse that the reference's variance adds
    double _relativeNoiseFixed = 0.0;
    double _noise = 0.0; ///< part of mse that the reference's variance adds
};

} // namespace osgRayTrace::bench
