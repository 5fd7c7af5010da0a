// Ssim.cpp - the structural similarity by separable Gaussians. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/Ssim.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace osgRayTrace::bench
{

namespace
{

constexpr int kReach = 5;
constexpr double kC1 = 0.01 * 255.0 * 0.01 * 255.0, kC2 = 0.03 * 255.0 * 0.03 * 255.0;

std::array<double, 2 * kReach + 1> gaussian()
{
    std::array<double, 2 * kReach + 1> weights;
    double sum = 0.0;
    for (int i = -kReach; i <= kReach; ++i)
        sum += weights[std::size_t(i + kReach)] = std::exp(-i * i / (2.0 * 1.5 * 1.5));
    for (double& weight : weights)
        weight /= sum;
    return weights;
}

/// Holds the sums of a and b, of their squares and of their product, under a Gaussian.
struct Moments
{
    double a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;

    void add(double weight, const Moments& m)
    {
        a += weight * m.a;
        b += weight * m.b;
        aa += weight * m.aa;
        bb += weight * m.bb;
        ab += weight * m.ab;
    }

    double similarity() const
    {
        const double variances = aa - a * a + bb - b * b, covariance = ab - a * b;
        return (2.0 * a * b + kC1) * (2.0 * covariance + kC2) /
               ((a * a + b * b + kC1) * (variances + kC2));
    }
};

/// Returns the sum of the similarities of one channel.
double sumOf(const uint8_t* a, const uint8_t* b, int width, int height)
{
    static const std::array<double, 2 * kReach + 1> kWeights = gaussian();
    const auto w = std::size_t(width);
    std::vector<Moments> columns(w * std::size_t(height));
    for (std::size_t row = kReach; row + kReach < std::size_t(height); ++row)
        for (std::size_t x = 0; x < w; ++x)
            for (std::size_t k = 0; k < kWeights.size(); ++k)
            {
                const std::size_t pixel = 4 * ((row + k - kReach) * w + x);
                const double p = a[pixel], q = b[pixel];
                columns[row * w + x].add(kWeights[k], {p, q, p * p, q * q, p * q});
            }
    double sum = 0.0;
    for (std::size_t row = kReach; row + kReach < std::size_t(height); ++row)
        for (std::size_t x = kReach; x + kReach < w; ++x)
        {
            Moments moments;
            for (std::size_t k = 0; k < kWeights.size(); ++k)
                moments.add(kWeights[k], columns[row * w + x + k - kReach]);
            sum += moments.similarity();
        }
    return sum;
}

} // namespace

double meanSsim(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b, int width, int height)
{
    if (width <= 2 * kReach || height <= 2 * kReach) return a == b ? 1.0 : 0.0;
    double sum = 0.0;
    for (std::size_t channel = 0; channel < 3; ++channel)
        sum += sumOf(a.data() + channel, b.data() + channel, width, height);
    return sum / (3.0 * (width - 2 * kReach) * (height - 2 * kReach));
}

} // namespace osgRayTrace::bench
