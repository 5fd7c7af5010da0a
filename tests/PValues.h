// PValues.h - tail probabilities of the tests that compare means, shares and distributions.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/Statistics.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace osgRayTrace::engine::test
{

/// Returns the probability that a normal variable is farther than |z| from its mean.
inline double normalTail(double z)
{
    return std::erfc(std::abs(z) / std::sqrt(2.0));
}

/// Returns the regularized incomplete beta function I_x(a, b), by its continued fraction.
inline double incompleteBeta(double a, double b, double x)
{
    if (x <= 0.0) return 0.0;
    if (x >= 1.0) return 1.0;
    // The continued fraction converges fast below the mean; above the mean the symmetry of I_x is
    // used.
    if (x > (a + 1.0) / (a + b + 2.0)) return 1.0 - incompleteBeta(b, a, 1.0 - x);
    const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                  a * std::log(x) + b * std::log1p(-x)) /
                         a;
    double fraction = 0.0;
    for (int m = 300; m >= 1; --m) // from the far end inwards
    {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        fraction = even / (1.0 + odd / (1.0 + fraction));
    }
    const double first = -(a + b) * x / (a + 1.0);
    return front / (1.0 + first / (1.0 + fraction));
}

/// Returns the probability that the absolute value of a variable of Student's distribution is
/// larger than |t|.
inline double studentTail(double t, double degrees)
{
    return incompleteBeta(0.5 * degrees, 0.5, degrees / (degrees + t * t));
}

/// Returns the probability of means this different if they are equal (Welch). A difference within
/// the rounding of float sums, given as a share of the means, counts for nothing.
inline double welchTest(const Estimate& a, std::size_t countA, const Estimate& b,
                        std::size_t countB, double rounding = 1e-5)
{
    const double va = a.standardError() * a.standardError();
    const double vb = b.standardError() * b.standardError();
    const double slack = rounding * std::max(std::abs(a.mean()), std::abs(b.mean()));
    const double difference = std::max(std::abs(a.mean() - b.mean()) - slack, 0.0);
    if (difference == 0.0) return 1.0;
    if (va + vb == 0.0) return 0.0;
    const double degrees =
        (va + vb) * (va + vb) /
        (va * va / static_cast<double>(countA - 1) + vb * vb / static_cast<double>(countB - 1));
    return studentTail(difference / std::sqrt(va + vb), degrees);
}

/// Returns the probability of a largest distance this large or larger between the empirical
/// distribution of independent values and the uniform one on [0,1] (Kolmogorov; Stephens's
/// correction for few values).
inline double kolmogorovSmirnovTest(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    const double n = static_cast<double>(values.size());
    double distance = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        const double below = static_cast<double>(i) / n, above = static_cast<double>(i + 1) / n;
        distance = std::max({distance, values[i] - below, above - values[i]});
    }
    const double x = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * distance;
    if (x < 0.3) return 1.0;
    double sum = 0.0;
    for (int k = 1; k <= 100; ++k)
        sum += (k % 2 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * x * x);
    return std::min(sum, 1.0);
}

} // namespace osgRayTrace::engine::test
