// BsdfDensity.cpp - tests whether the samples of a Bsdf have the density that it claims.
// SPDX-License-Identifier: MIT
#include "tests/shading/BsdfDensity.h"

#include "tests/Statistics.h"

#include "osgRayTrace/shading/Fresnel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace osgRayTrace::engine::test
{

namespace
{

constexpr int kRows = 20, kColumns = 16;

/// Cells around an axis: rows of angles that grow geometrically from the width of the lobe's peak,
/// so that narrow and broad lobes are resolved alike.
struct Grid
{
    Vec3d axis, tangent, bitangent;
    std::array<double, kRows + 1> edges{};

    Grid(const Vec3& around, double smallest) : axis(glm::normalize(Vec3d(around)))
    {
        const Vec3d other = std::abs(axis.z) < 0.9 ? Vec3d(0, 0, 1) : Vec3d(1, 0, 0);
        tangent = glm::normalize(glm::cross(other, axis));
        bitangent = glm::cross(axis, tangent);
        for (int row = 1; row <= kRows; ++row)
            edges[static_cast<std::size_t>(row)] =
                smallest * std::pow(M_PI / smallest, (row - 1.0) / (kRows - 1));
    }

    Vec3d direction(double theta, double phi) const
    {
        return axis * std::cos(theta) +
               (tangent * std::cos(phi) + bitangent * std::sin(phi)) * std::sin(theta);
    }

    std::size_t cellOf(const Vec3& w) const
    {
        const Vec3d d(w);
        const double x = glm::dot(d, tangent), y = glm::dot(d, bitangent);
        const double theta = std::atan2(std::hypot(x, y), glm::dot(d, axis));
        double phi = std::atan2(y, x);
        if (phi < 0.0) phi += 2.0 * M_PI;
        const auto at = std::upper_bound(edges.begin() + 1, edges.end() - 1, theta);
        const auto row = static_cast<std::size_t>(at - edges.begin() - 1);
        const auto column = std::min<std::size_t>(
            kColumns - 1, static_cast<std::size_t>(phi / (2.0 * M_PI) * kColumns));
        return row * kColumns + column;
    }
};

/// Integrates the density over a cell, on one side of the surface. The cell is split if the
/// integral requires it, and always along the horizon.
class CellIntegral
{
public:
    CellIntegral(const Bsdf& bsdf, Vec3 wo, const Grid& grid, bool above)
        : _bsdf(bsdf), _wo(wo), _grid(grid), _above(above)
    {
    }

    double operator()(double theta0, double theta1, double phi0, double phi1) const
    {
        return refined(theta0, theta1, phi0, phi1, rule(theta0, theta1, phi0, phi1), 0);
    }

    int bad() const { return _bad; }

private:
    double density(double theta, double phi) const
    {
        const Vec3 wi(_grid.direction(theta, phi));
        if (wi.z == 0.0f || (wi.z > 0.0f) != _above) return 0.0;
        const double pdfW = evalBsdf(_bsdf, _wo, wi).pdfW;
        _bad += !(pdfW >= 0.0 && std::isfinite(pdfW));
        return pdfW * std::sin(theta);
    }

    /// Applies the Gauss-Legendre rule of 3 x 3 points.
    double rule(double theta0, double theta1, double phi0, double phi1) const
    {
        static const double kPoint[] = {-0.7745966692414834, 0.0, 0.7745966692414834};
        static const double kWeight[] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
        double sum = 0.0;
        for (int i = 0; i < 3; ++i)
        {
            for (int j = 0; j < 3; ++j)
                sum += kWeight[i] * kWeight[j] *
                       density(0.5 * (theta0 + theta1 + kPoint[i] * (theta1 - theta0)),
                               0.5 * (phi0 + phi1 + kPoint[j] * (phi1 - phi0)));
        }
        return sum * (theta1 - theta0) * (phi1 - phi0);
    }

    double refined(double theta0, double theta1, double phi0, double phi1, double whole,
                   int depth) const
    {
        const double theta = 0.5 * (theta0 + theta1), phi = 0.5 * (phi0 + phi1);
        const double a = rule(theta0, theta, phi0, phi), b = rule(theta0, theta, phi, phi1);
        const double c = rule(theta, theta1, phi0, phi), d = rule(theta, theta1, phi, phi1);
        const double sum = a + b + c + d;
        const double reach = 0.5 * (theta1 - theta0) + 0.5 * (phi1 - phi0) * std::sin(theta);
        const bool horizon = std::abs(_grid.direction(theta, phi).z) < reach;
        if (depth >= 7 || (depth > 1 && !horizon && std::abs(sum - whole) < 1e-7)) return sum;
        return refined(theta0, theta, phi0, phi, a, depth + 1) +
               refined(theta0, theta, phi, phi1, b, depth + 1) +
               refined(theta, theta1, phi0, phi, c, depth + 1) +
               refined(theta, theta1, phi, phi1, d, depth + 1);
    }

    const Bsdf& _bsdf;
    Vec3 _wo;
    const Grid& _grid;
    bool _above;
    mutable int _bad = 0; ///< densities that are negative or not finite
};

} // namespace

DensityResult testDensity(const Bsdf& bsdf, Vec3 wo, uint32_t seed, int samples)
{
    const double smallest = std::max(0.1 * bsdf.alpha, 1e-4);
    // The axis is the refraction by the middle one of the visible normals: from grazing angles few
    // of them point straight up.
    const std::optional<Vec3> through =
        refract(wo, sampleGgxVisible(wo, bsdf.alpha, 0.5f, 0.5f), bsdf.eta);
    // Normals that scatter by alpha turn refracted rays by |eta - 1| alpha.
    const double bend = std::min(1.0, std::abs(bsdf.eta - 1.0) + 1e-3);
    const Grid above(Vec3(-wo.x, -wo.y, wo.z), smallest),
        below(through ? *through : -wo, smallest * bend);

    std::vector<double> observed(2 * kRows * kColumns + 1, 0.0), expected(observed.size(), 0.0);
    DensityResult result;
    double deltaPmf = 0.0; // of a last cell, for refraction that is not rough
    Uniform random(seed);
    for (int i = 0; i < samples; ++i)
    {
        const float uLobe = random(), u = random(), v = random();
        const std::optional<BsdfSample> sample = sampleBsdf(bsdf, wo, uLobe, u, v);
        if (!sample) continue;
        result.accepted += 1.0 / samples;
        if (sample->delta)
        {
            ++observed.back();
            deltaPmf = sample->pdfW;
            continue;
        }
        const bool isAbove = sample->wi.z > 0.0f;
        ++observed[isAbove ? above.cellOf(sample->wi)
                           : kRows * kColumns + below.cellOf(sample->wi)];
        const BsdfValue value = evalBsdf(bsdf, wo, sample->wi);
        const Vec3 difference = sample->weight * sample->pdfW - value.fCos;
        result.inconsistent += sample->pdfW != value.pdfW || sample->transmitted == isAbove ||
                               glm::length(difference) > 1e-5f * (glm::length(value.fCos) + 1e-20f);
    }
    for (int side = 0; side < 2; ++side)
    {
        if (side == 1 && !bsdf.passesLight()) break;
        const Grid& grid = side ? below : above;
        const CellIntegral integral(bsdf, wo, grid, side == 0);
        for (std::size_t row = 0; row < kRows; ++row)
        {
            for (std::size_t column = 0; column < kColumns; ++column)
            {
                const double width = 2.0 * M_PI / kColumns;
                const double probability =
                    integral(grid.edges[row], grid.edges[row + 1], width * double(column),
                             width * double(column + 1));
                const std::size_t cell =
                    (static_cast<std::size_t>(side) * kRows + row) * kColumns + column;
                expected[cell] = probability * samples;
                result.total += probability;
                if (probability == 0.0) result.withoutDensity += observed[cell];
            }
        }
        result.bad += integral.bad();
    }
    expected.back() = deltaPmf * samples;
    result.total += deltaPmf;
    result.fit = chiSquareTest(observed, expected);
    return result;
}

} // namespace osgRayTrace::engine::test
