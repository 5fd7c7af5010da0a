// Flip.cpp - LDR-FLIP from its publication. Layer: apps.
// SPDX-License-Identifier: MIT
//
// FLIP consists of two pipelines [Andersson20, sect. 4]. One compares colours, blurred as the eye
// blurs them, in a space of equal differences. The other compares edges and points, which count for
// more than their colours do.
//
//   FLIP = colourDifference^(1 - featureDifference)
#include "apps/osgraytracebench/report/Flip.h"

#include "osgRayTrace/film/ToneMap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace osgRayTrace::bench
{

namespace
{

using Plane = std::vector<double>;
using Color = std::array<double, 3>;
using Planes = std::array<Plane, 3>;

struct Size
{
    int width, height;
    std::size_t pixels() const { return static_cast<std::size_t>(width) * height; }
};

// The matrix has sRGB's primaries with white point D65 [IEC61966].
constexpr double kXyzFromRgb[3][3] = {
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};

Color xyzFromRgb(const Color& rgb)
{
    Color xyz{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            xyz[i] += kXyzFromRgb[i][j] * rgb[j];
    return xyz;
}

const Color& white()
{
    static const Color color = xyzFromRgb({1.0, 1.0, 1.0});
    return color;
}

Color rgbFromXyz(const Color& xyz)
{
    // The inverse of kXyzFromRgb is computed by cofactors.
    const auto& m = kXyzFromRgb;
    const auto cofactor = [&](int r, int c)
    {
        const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
        return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
    };
    const double determinant =
        m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
    Color rgb{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            rgb[static_cast<std::size_t>(i)] +=
                cofactor(j, i) / determinant * xyz[static_cast<std::size_t>(j)];
    return rgb;
}

/// Returns YCxCz, linear and opponent [Andersson20, sect. 4.1.1].
Color opponentFromXyz(const Color& xyz)
{
    const double x = xyz[0] / white()[0], y = xyz[1] / white()[1], z = xyz[2] / white()[2];
    return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

Color xyzFromOpponent(const Color& c)
{
    const double y = (c[0] + 16.0) / 116.0;
    return {(y + c[1] / 500.0) * white()[0], y * white()[1], (y - c[2] / 200.0) * white()[2]};
}

/// Returns CIE L*a*b* with the chroma of dark colours reduced (Hunt's effect) [Andersson20, sect.
/// 4.1.2].
Color perceived(const Color& rgb)
{
    const Color xyz = xyzFromRgb(rgb);
    const auto bent = [](double t)
    {
        constexpr double kDelta = 6.0 / 29.0;
        return t > kDelta * kDelta * kDelta ? std::cbrt(t)
                                            : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
    };
    const double x = bent(xyz[0] / white()[0]), y = bent(xyz[1] / white()[1]),
                 z = bent(xyz[2] / white()[2]);
    const double lightness = 116.0 * y - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)};
}

/// Returns the HyAB distance: city block in lightness, Euclidean in chroma [Andersson20, sect.
/// 4.1.3].
double hyab(const Color& a, const Color& b)
{
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

/// Returns differences compressed to [0,1]: almost all of the range is for small ones [Andersson20,
/// sect. 4.1.4].
double colourDifference(double distance)
{
    constexpr double kExponent = 0.7, kKnee = 0.4, kKneeValue = 0.95;
    static const double largest =
        std::pow(hyab(perceived({0.0, 1.0, 0.0}), perceived({0.0, 0.0, 1.0})), kExponent);
    const double value = std::pow(distance, kExponent), knee = kKnee * largest;
    if (value < knee) return kKneeValue / knee * value;
    return kKneeValue + (value - knee) / (largest - knee) * (1.0 - kKneeValue);
}

/// Filters rows, then columns, with the kernel of 2*radius+1 values each; the border is continued.
Plane filtered(const Plane& in, Size size, const std::vector<double>& alongX,
               const std::vector<double>& alongY)
{
    const auto at = [](int x, int limit) { return std::clamp(x, 0, limit - 1); };
    const auto index = [size](int x, int y)
    { return static_cast<std::size_t>(y) * size.width + x; };
    const int radius = static_cast<int>(alongX.size() / 2);
    Plane rows(in.size()), out(in.size());
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            for (int i = -radius; i <= radius; ++i)
                rows[index(x, y)] += alongX[static_cast<std::size_t>(i + radius)] *
                                     in[index(at(x + i, size.width), y)];
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            for (int i = -radius; i <= radius; ++i)
                out[index(x, y)] += alongY[static_cast<std::size_t>(i + radius)] *
                                    rows[index(x, at(y + i, size.height))];
    return out;
}

template <typename Function> std::vector<double> sampled(int radius, const Function& function)
{
    std::vector<double> values;
    for (int i = -radius; i <= radius; ++i)
        values.push_back(function(i));
    return values;
}

double sumOf(const std::vector<double>& values)
{
    double sum = 0.0;
    for (const double value : values)
        sum += value;
    return sum;
}

/// Describes the eye's contrast sensitivity, a sqrt(pi / b) exp(-pi^2 r^2 / b), r in degrees
/// [Andersson20, eq. 4 and table 1].
struct Gaussian
{
    double a, b;
};

constexpr std::array<std::array<Gaussian, 2>, 3> kSensitivity = {{{{{1.0, 0.0047}, {0.0, 1e-5}}},
                                                                  {{{1.0, 0.0053}, {0.0, 1e-5}}},
                                                                  {{{34.1, 0.04}, {13.5, 0.025}}}}};
constexpr double kWidestB = 0.04;

Plane seen(const Plane& channel, Size size, const std::array<Gaussian, 2>& gaussians,
           double pixelsPerDegree)
{
    const int radius = static_cast<int>(
        std::ceil(3.0 * std::sqrt(kWidestB / (2.0 * M_PI * M_PI)) * pixelsPerDegree));
    Plane sum(channel.size());
    double weightSum = 0.0;
    for (const Gaussian& g : gaussians)
    {
        if (g.a == 0.0) continue;
        const std::vector<double> kernel =
            sampled(radius,
                    [&](int i)
                    {
                        const double degrees = i / pixelsPerDegree;
                        return std::exp(-M_PI * M_PI * degrees * degrees / g.b);
                    });
        const double weight = g.a * std::sqrt(M_PI / g.b);
        weightSum += weight * sumOf(kernel) * sumOf(kernel);
        const Plane part = filtered(channel, size, kernel, kernel);
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += weight * part[i];
    }
    for (double& value : sum)
        value /= weightSum;
    return sum;
}

/// Returns the kernel scaled so that positive weights sum to 1, and negative ones to -1.
std::vector<double> balanced(std::vector<double> kernel)
{
    double positive = 0.0, negative = 0.0;
    for (const double value : kernel)
        (value > 0.0 ? positive : negative) += value;
    for (double& value : kernel)
        value /= value > 0.0 ? positive : -negative;
    return kernel;
}

/// Holds the strength of edges and of points at each pixel [Andersson20, sect. 4.2].
struct Features
{
    Plane edges, points;
};

Features featuresOf(const Plane& luminance, Size size, double pixelsPerDegree)
{
    constexpr double kWidthDegrees = 0.082;
    const double deviation = 0.5 * kWidthDegrees * pixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3.0 * deviation));
    const auto bell = [deviation](int i)
    { return std::exp(-0.5 * i * i / (deviation * deviation)); };
    std::vector<double> smooth = sampled(radius, bell);
    const double total = sumOf(smooth);
    for (double& value : smooth)
        value /= total;
    const std::vector<double> first =
        balanced(sampled(radius, [&](int i) { return -i * bell(i); }));
    const std::vector<double> second = balanced(
        sampled(radius, [&](int i) { return (i * i / (deviation * deviation) - 1.0) * bell(i); }));

    const auto strength = [&](const std::vector<double>& kernel)
    {
        const Plane x = filtered(luminance, size, kernel, smooth);
        const Plane y = filtered(luminance, size, smooth, kernel);
        Plane length(x.size());
        for (std::size_t i = 0; i < x.size(); ++i)
            length[i] = std::hypot(x[i], y[i]);
        return length;
    };
    return {strength(first), strength(second)};
}

struct Prepared
{
    Planes colours; ///< filtered, perceived
    Features features;
};

Prepared prepared(const std::vector<float>& picture, Size size, double pixelsPerDegree)
{
    Planes opponent;
    for (Plane& plane : opponent)
        plane.resize(size.pixels());
    Plane luminance(size.pixels());
    for (std::size_t i = 0; i < size.pixels(); ++i)
    {
        Color linear{};
        for (std::size_t c = 0; c < 3; ++c)
            linear[c] = engine::linearFromSrgb(std::clamp(picture[3 * i + c], 0.0f, 1.0f));
        const Color color = opponentFromXyz(xyzFromRgb(linear));
        for (std::size_t c = 0; c < 3; ++c)
            opponent[c][i] = color[c];
        luminance[i] = (color[0] + 16.0) / 116.0;
    }

    Prepared result;
    for (std::size_t c = 0; c < 3; ++c)
        result.colours[c] = seen(opponent[c], size, kSensitivity[c], pixelsPerDegree);
    for (std::size_t i = 0; i < size.pixels(); ++i)
    {
        Color rgb = rgbFromXyz(
            xyzFromOpponent({result.colours[0][i], result.colours[1][i], result.colours[2][i]}));
        for (double& value : rgb)
            value = std::clamp(value, 0.0, 1.0);
        const Color color = perceived(rgb);
        for (std::size_t c = 0; c < 3; ++c)
            result.colours[c][i] = color[c];
    }
    result.features = featuresOf(luminance, size, pixelsPerDegree);
    return result;
}

} // namespace

std::vector<float> flip(const std::vector<float>& reference, const std::vector<float>& test,
                        int width, int height, double pixelsPerDegree)
{
    const Size size{width, height};
    const Prepared a = prepared(reference, size, pixelsPerDegree);
    const Prepared b = prepared(test, size, pixelsPerDegree);
    std::vector<float> result(size.pixels());
    for (std::size_t i = 0; i < result.size(); ++i)
    {
        const double distance = hyab({a.colours[0][i], a.colours[1][i], a.colours[2][i]},
                                     {b.colours[0][i], b.colours[1][i], b.colours[2][i]});
        const double edges = std::abs(a.features.edges[i] - b.features.edges[i]);
        const double points = std::abs(a.features.points[i] - b.features.points[i]);
        const double feature = std::sqrt(std::max(edges, points) / std::sqrt(2.0));
        result[i] = static_cast<float>(std::pow(colourDifference(distance), 1.0 - feature));
    }
    return result;
}

double meanFlip(const std::vector<float>& reference, const std::vector<float>& test, int width,
                int height)
{
    double sum = 0.0;
    for (const float value : flip(reference, test, width, height))
        sum += value;
    return sum / (static_cast<double>(width) * height);
}

} // namespace osgRayTrace::bench
