// BudgetSums.cpp - error measures over seeds. Layer: apps.
// SPDX-License-Identifier: MIT
//
// The measures compare pictures x_k, k = 1..K, with a reference r whose own variance v is known
// [Celarek19, sect. 4]:
//
//   MSE      = mean over k and pixels of (x_k - r)^2 - v
//   V        = mean over pixels of the unbiased variance of x_k over k
//   bias     = mean over k and pixels of x_k - r,
//              with variance sum over pixels (var_k / K + v) / pixels^2
#include "apps/osgraytracebench/report/BudgetSums.h"

#include "apps/common/ErrorMeasures.h"
#include "apps/osgraytracebench/report/DisplayValues.h"
#include "apps/osgraytracebench/report/Flip.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::bench
{

namespace
{

constexpr double kRelativeOffset = 0.01; ///< share of the mean luminance

/// Rounding of floats on the way from a light sample to a pixel's mean does not average out
/// altogether: this is its relative size.
constexpr double kRounding = 0x1p-22;

double offsetOf(const Reference& reference)
{
    return std::pow(kRelativeOffset * reference.meanLuminance, 2.0);
}

} // namespace

BudgetSums::BudgetSums(const Reference& reference)
    : _reference(reference),
      _difference(reference.mean.size()),
      _squares(reference.mean.size()),
      _pixelSquares(reference.mean.size() / 3)
{
    const double offset = offsetOf(reference), count = static_cast<double>(reference.mean.size());
    for (std::size_t i = 0; i < reference.mean.size(); ++i)
    {
        const double square = reference.mean[i] * reference.mean[i];
        _noise += reference.variance[i] / count;
        _relativeNoise += reference.variance[i] / (square + offset) / count;
        _relativeNoiseFixed += reference.variance[i] / (square + app::kRelMseOffset) / count;
    }
}

void BudgetSums::add(const Pixels& pixels, const PictureCost& cost)
{
    app::ErrorSum relative(offsetOf(_reference)), fixed;
    std::vector<double> errors;
    errors.reserve(pixels.rgb.size());
    _nonFinite += cost.dropped;
    for (std::size_t p = 0; p < _pixelSquares.size(); ++p)
    {
        double pixel = 0.0;
        for (std::size_t i = 3 * p; i < 3 * p + 3; ++i)
        {
            const double x = pixels.rgb[i], r = _reference.mean[i];
            if (!std::isfinite(x))
            {
                ++_nonFinite;
                continue;
            }
            relative.add(x, r);
            fixed.add(x, r);
            errors.push_back(std::abs(x - r));
            _difference[i] += x - r;
            _squares[i] += (x - r) * (x - r);
            pixel += x - r;
        }
        _pixelSquares[p] += pixel * pixel;
    }
    const app::ErrorMeasures measures = relative.measures();
    _relMse.push_back(measures.relMse - _relativeNoise);
    _relMseFixed.push_back(fixed.measures().relMse - _relativeNoiseFixed);
    _mse.push_back(measures.rmse * measures.rmse - _noise);
    const auto rank = errors.begin() + static_cast<std::ptrdiff_t>(0.999 * (errors.size() - 1.0));
    std::nth_element(errors.begin(), rank, errors.end());
    _percentile.push_back(*rank);
    _seconds.push_back(cost.seconds);
    _passes.push_back(cost.passes);
    _rays.push_back(cost.rays);
    if (cost.wantsFlip)
        _flip.push_back(meanFlip(displayValues(_reference), displayValues(pixels, _reference),
                                 pixels.width, pixels.height));
}

ReportRow BudgetSums::row() const
{
    ReportRow row;
    const double count = static_cast<double>(seeds());
    const Mean relMse = meanOf(_relMse), mse = meanOf(_mse);
    row.seeds = static_cast<int>(seeds());
    row.seconds = meanOf(_seconds).value;
    row.passes = meanOf(_passes).value;
    row.rays = meanOf(_rays).value;
    row.relMse = relMse.value;
    row.relMseError = relMse.error;
    row.relMseFixed = meanOf(_relMseFixed).value;
    row.mse = mse.value;
    row.mseError = mse.error;
    row.percentile999 = meanOf(_percentile).value;
    if (!_flip.empty()) row.flip = meanOf(_flip).value;
    row.nonFinite = _nonFinite;

    double variance = row.mse; // nothing better is known from one picture
    if (seeds() > 1)
    {
        variance = 0.0;
        for (std::size_t i = 0; i < _squares.size(); ++i)
            variance += (_squares[i] - _difference[i] * _difference[i] / count) / (count - 1.0);
        variance /= static_cast<double>(_squares.size());
    }
    row.variance = variance;
    row.efficiency = variance > 0.0 ? 1.0 / (variance * row.seconds) : 0.0;
    addBias(row);
    return row;
}

void BudgetSums::addBias(ReportRow& row) const
{
    // The colours of a pixel come from the same samples, so that a pixel counts as one value, the
    // sum of its colours.
    const double count = static_cast<double>(seeds());
    double bias = 0.0, variance = 0.0;
    for (std::size_t p = 0; p < _pixelSquares.size(); ++p)
    {
        double sum = 0.0, referenceDeviation = 0.0;
        for (std::size_t i = 3 * p; i < 3 * p + 3; ++i)
        {
            sum += _difference[i];
            referenceDeviation += std::sqrt(_reference.variance[i]); // as if fully correlated
        }
        bias += sum / count;
        const double scatter =
            seeds() > 1 ? (_pixelSquares[p] - sum * sum / count) / (count - 1.0) : _pixelSquares[p];
        variance += std::max(scatter, 0.0) / count + referenceDeviation * referenceDeviation;
    }
    const double values = static_cast<double>(_difference.size());
    const double percent = 100.0 / (_reference.meanValue * values);
    row.biasPercent = percent * bias;
    row.biasError = std::hypot(percent * std::sqrt(variance), 100.0 * kRounding);
}

} // namespace osgRayTrace::bench
