// Statistics.h - what statistical tests need: means with their errors, chi-square, slopes.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace osgRayTrace::engine::test
{

/// Normal numbers by Box and Muller's method. Those of std::normal_distribution differ from one
/// standard library to the next.
class NormalNumbers
{
public:
    explicit NormalNumbers(double mean = 0.0, double deviation = 1.0)
        : _mean(mean), _deviation(deviation)
    {
    }

    double operator()(std::mt19937& random) const
    {
        const double u = (double(random()) + 0.5) / 4294967296.0,
                     v = double(random()) / 4294967296.0;
        return _mean + _deviation * std::sqrt(-2.0 * std::log(u)) * std::cos(6.283185307179586 * v);
    }

private:
    double _mean, _deviation;
};

/// Mean of independent values and the standard error of it.
class Estimate
{
public:
    void add(double value)
    {
        ++_count;
        const double delta = value - _mean;
        _mean += delta / static_cast<double>(_count);
        _squares += delta * (value - _mean);
    }

    double mean() const { return _mean; }
    double variance() const
    {
        return _count > 1 ? _squares / static_cast<double>(_count - 1) : 0.0;
    }
    double standardError() const { return std::sqrt(variance() / static_cast<double>(_count)); }

    /// True if the mean lies within 4 standard errors of expected, and rounding beside them. A
    /// false alarm has a probability of 6e-5 for many values, 1e-3 for sixteen.
    bool agrees(double expected, double rounding = 0.0) const
    {
        return std::abs(_mean - expected) <= 4.0 * standardError() + rounding;
    }

private:
    std::size_t _count = 0;
    double _mean = 0.0;
    double _squares = 0.0;
};

/// Probability that a chi-square variable exceeds the value, by Wilson and Hilferty's cube root.
inline double chiSquareTail(double value, double degrees)
{
    const double variance = 2.0 / (9.0 * degrees);
    const double z = (std::cbrt(value / degrees) - (1.0 - variance)) / std::sqrt(variance);
    return 0.5 * std::erfc(z / std::sqrt(2.0));
}

/// Pearson's test of counts against expected ones; cells are pooled to an expected count of 5 at
/// least. Returns the probability of a fit this bad or worse.
inline double chiSquareTest(const std::vector<double>& observed,
                            const std::vector<double>& expected)
{
    struct Cell
    {
        double observed = 0.0, expected = 0.0;
    };
    std::vector<Cell> cells;
    Cell pool;
    for (std::size_t i = 0; i < observed.size(); ++i)
    {
        pool.observed += observed[i];
        pool.expected += expected[i];
        if (pool.expected < 5.0) continue;
        cells.push_back(pool);
        pool = {};
    }
    if (cells.size() < 2) return 1.0;
    cells.back().observed += pool.observed;
    cells.back().expected += pool.expected;
    double sum = 0.0;
    for (const Cell& cell : cells)
        sum += (cell.observed - cell.expected) * (cell.observed - cell.expected) / cell.expected;
    return chiSquareTail(sum, static_cast<double>(cells.size() - 1));
}

/// Significance of each of count tests so that all together raise a false alarm with probability
/// significance (Sidak).
inline double sidak(double significance, int count)
{
    return 1.0 - std::pow(1.0 - significance, 1.0 / count);
}

/// Slope of log(y) over log(x), least squares.
inline double logLogSlope(const std::vector<double>& x, const std::vector<double>& y)
{
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
        const double lx = std::log(x[i]), ly = std::log(y[i]);
        sx += lx;
        sy += ly;
        sxx += lx * lx;
        sxy += lx * ly;
    }
    const double n = static_cast<double>(x.size());
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// Uniform numbers in [0,1) with a fixed seed.
class Uniform
{
public:
    explicit Uniform(uint32_t seed) : _engine(seed) {}
    float operator()() { return static_cast<float>(_engine() >> 8) * 0x1p-24f; }
    double between(double low, double high) { return low + (high - low) * (*this)(); }

private:
    std::mt19937 _engine;
};

} // namespace osgRayTrace::engine::test
