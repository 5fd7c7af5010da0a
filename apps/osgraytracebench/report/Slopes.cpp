// Slopes.cpp - least squares, the jackknife, Student's distribution. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/Slopes.h"

#include <cmath>
#include <limits>

namespace osgRayTrace::bench
{

namespace
{

/// Returns the slope of all series but the one left out.
std::optional<double> slopeWithout(const std::vector<Series>& series, std::size_t leftOut)
{
    std::size_t points = 0;
    for (const Series& s : series)
        points = std::max(points, s.y.size());
    double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (std::size_t p = 0; p < points; ++p)
    {
        double count = 0.0, x = 0.0, y = 0.0;
        for (std::size_t s = 0; s < series.size(); ++s)
        {
            if (s == leftOut || p >= series[s].y.size()) continue;
            count += 1.0;
            x += series[s].x[p];
            y += series[s].y[p];
        }
        if (!(x > 0.0) || !(y > 0.0)) continue;
        const double logX = std::log(x / count), logY = std::log(y / count);
        n += 1.0;
        sx += logX;
        sy += logY;
        sxx += logX * logX;
        sxy += logX * logY;
    }
    const double determinant = n * sxx - sx * sx;
    if (n < 2.0 || !(determinant > 0.0)) return std::nullopt;
    return (n * sxy - sx * sy) / determinant;
}

/// Returns the continued fraction of the incomplete beta function, by Lentz's method.
double betaFraction(double a, double b, double x)
{
    constexpr double kTiny = 1e-300;
    double c = 1.0, d = 1.0 - (a + b) * x / (a + 1.0);
    d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
    double h = d;
    for (int m = 1; m < 500; ++m)
    {
        const double m2 = 2.0 * m;
        for (const double term : {m * (b - m) * x / ((a + m2 - 1.0) * (a + m2)),
                                  -(a + m) * (a + b + m) * x / ((a + m2) * (a + m2 + 1.0))})
        {
            d = 1.0 + term * d;
            d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
            c = 1.0 + term / c;
            if (std::abs(c) < kTiny) c = kTiny;
            h *= d * c;
        }
        if (std::abs(d * c - 1.0) < 1e-14) break;
    }
    return h;
}

/// Returns the regularized incomplete beta function.
double incompleteBeta(double a, double b, double x)
{
    if (x <= 0.0) return 0.0;
    if (x >= 1.0) return 1.0;
    const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                  a * std::log(x) + b * std::log1p(-x));
    if (x < (a + 1.0) / (a + b + 2.0)) return front * betaFraction(a, b, x) / a;
    return 1.0 - front * betaFraction(b, a, 1.0 - x) / b;
}

} // namespace

Mean meanOf(const std::vector<double>& values)
{
    const double n = static_cast<double>(values.size());
    double sum = 0.0, squares = 0.0;
    for (const double value : values)
        sum += value;
    const double mean = sum / n;
    for (const double value : values)
        squares += (value - mean) * (value - mean);
    const double error = values.size() > 1 ? std::sqrt(squares / (n * (n - 1.0)))
                                           : std::numeric_limits<double>::infinity();
    return {mean, error};
}

std::optional<Slope> logLogSlope(const std::vector<Series>& series)
{
    const std::optional<double> whole = slopeWithout(series, series.size());
    if (!whole) return std::nullopt;
    std::vector<double> parts;
    for (std::size_t s = 0; s < series.size(); ++s)
    {
        if (const std::optional<double> part = slopeWithout(series, s)) parts.push_back(*part);
    }
    if (parts.size() < 2) return Slope{*whole, std::numeric_limits<double>::infinity()};
    // This is the jackknife: (n - 1)/n times the sum of squares is (n - 1)^2 times that of the
    // mean's error.
    const double n = static_cast<double>(parts.size());
    return Slope{*whole, (n - 1.0) * meanOf(parts).error};
}

std::optional<double> crossing(const std::vector<double>& x, const std::vector<double>& y,
                               double target)
{
    for (std::size_t i = 1; i < x.size(); ++i)
    {
        const bool usable = y[i - 1] > 0.0 && y[i] > 0.0;
        if (!usable || y[i - 1] < target || y[i] > target) continue;
        if (y[i] == y[i - 1]) return x[i];
        const double part = std::log(target / y[i - 1]) / std::log(y[i] / y[i - 1]);
        return x[i - 1] * std::pow(x[i] / x[i - 1], part);
    }
    return std::nullopt;
}

double studentTail(double t, double degrees)
{
    if (!(degrees > 0.0)) return 1.0;
    return incompleteBeta(0.5 * degrees, 0.5, degrees / (degrees + t * t));
}

double sidak(double significance, std::size_t count)
{
    if (count == 0) return significance;
    return -std::expm1(std::log1p(-significance) / static_cast<double>(count));
}

} // namespace osgRayTrace::bench
