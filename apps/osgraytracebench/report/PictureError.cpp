// PictureError.cpp - errors of pixels, sorted, and medians over pictures. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/PictureError.h"

#include "apps/osgraytracebench/report/Slopes.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::bench
{

namespace
{

constexpr double kFloor = 0.01; ///< share of the mean luminance
constexpr std::size_t kWorst = 1000;

/// The standard error of a median of normally distributed values over that of their mean.
const double kMedianError = std::sqrt(0.5 * M_PI);

/// Returns the value that |t| of Student's distribution exceeds in 5 of 100 cases.
double studentQuantile(double degrees)
{
    double low = 0.0, high = 64.0;
    for (int step = 0; step < 60; ++step)
    {
        const double middle = 0.5 * (low + high);
        (studentTail(middle, degrees) > 0.05 ? low : high) = middle;
    }
    return low;
}

double middleOf(const std::vector<double>& sorted)
{
    const std::size_t half = sorted.size() / 2;
    return sorted.size() % 2 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
}

} // namespace

PictureError pictureError(const Pixels& pixels, const Reference& reference)
{
    const double floor = std::pow(kFloor * reference.meanLuminance, 2.0);
    struct Square
    {
        double whole, own; ///< with and without the reference's variance
    };
    std::vector<Square> squares(reference.mean.size() / 3, Square{0.0, 0.0});
    for (std::size_t i = 0; i < reference.mean.size(); ++i)
    {
        const double r = reference.mean[i], d = static_cast<double>(pixels.rgb[i]) - r;
        const double scale = 1.0 / (r * r + floor);
        squares[i / 3].whole += d * d * scale;
        squares[i / 3].own += (d * d - reference.variance[i]) * scale;
    }
    std::sort(squares.begin(), squares.end(),
              [](const Square& a, const Square& b) { return a.whole < b.whole; });
    const std::size_t kept = squares.size() - std::max<std::size_t>(1, squares.size() / kWorst);
    double sum = 0.0;
    PictureError error;
    for (std::size_t p = 0; p < squares.size(); ++p)
    {
        if (p == kept) error.trimmed = sum / (3.0 * static_cast<double>(kept));
        sum += squares[p].own;
    }
    error.relMse = sum / (3.0 * static_cast<double>(squares.size()));
    return error;
}

SeedMedian medianOfSeeds(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    const auto positive = std::upper_bound(values.begin(), values.end(), 0.0);
    if (positive == values.end()) return {};
    std::fill(values.begin(), positive, *positive);
    SeedMedian median{middleOf(values), values.back() / values.front(), 1.0};
    const auto count = static_cast<double>(values.size());
    double mean = 0.0, squares = 0.0;
    for (const double value : values)
        mean += std::log(value) / count;
    for (const double value : values)
        squares += std::pow(std::log(value) - mean, 2.0) / (count - 1.0);
    // Two medians have sqrt(2) times the standard error of one; the deviation is itself estimated.
    median.agreement =
        std::exp(studentQuantile(count - 1.0) * kMedianError * std::sqrt(2.0 * squares / count));
    return median;
}

} // namespace osgRayTrace::bench
