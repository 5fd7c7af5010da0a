// EnvironmentMap.cpp - tables of an image of the sphere, and look-ups. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/EnvironmentMap.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr double kTwoPi = 6.283185307179586476925;

/// A running sum is kept for each block of pixels, and the pixels within a block are added up when
/// a sample falls into the block: half a byte a pixel instead of eight.
constexpr int kBlock = 16;

/// A sky whose light above the mean is less than this share of it counts as even.
constexpr double kLeastUneven = 1e-4;

/// Returns the weight of a pixel: how much its luminance exceeds a floor.
double weightOf(Vec3 radiance, double floor)
{
    return std::max(0.0, luminance(radiance) - floor);
}

/// Returns the index of the entry of a running sum that target, which is below the last entry,
/// falls into.
std::size_t entryOf(const double* sums, std::size_t count, double target)
{
    return static_cast<std::size_t>(std::upper_bound(sums, sums + count - 1, target) - sums);
}

/// Returns atan2(y, x) to 2e-8 beside rounding, in half of the library's time
/// [AbramowitzStegun64, eq. 4.4.49].
float arcTangent(float y, float x)
{
    const float height = std::fabs(y), width = std::fabs(x);
    const float larger = std::max(height, width);
    const float t = larger > 0.0f ? std::min(height, width) / larger : 0.0f;
    const float s = t * t;
    float series = 0.0028662257f;
    for (const float term : {-0.0161657367f, 0.0429096138f, -0.0752896400f, 0.1065626393f,
                             -0.1420889944f, 0.1999355085f, -0.3333314528f, 1.0f})
        series = series * s + term;
    float angle = t * series;
    if (height > width) angle = 0.5f * kPi - angle;
    if (x < 0.0f) angle = kPi - angle;
    return y < 0.0f ? -angle : angle;
}

/// Returns the point of the image that a direction points to, in pixels; x in [0, width], y in [0,
/// height].
Vec2 imagePoint(const EnvironmentImage& image, Vec3 d)
{
    constexpr float kPerTurn = static_cast<float>(1.0 / kTwoPi);
    const float turn = arcTangent(d.x, d.y) * kPerTurn + 0.5f;
    const float height = arcTangent(d.z, std::sqrt(d.x * d.x + d.y * d.y)) * kInvPi + 0.5f;
    return Vec2(turn * static_cast<float>(image.width), height * static_cast<float>(image.height));
}

} // namespace

EnvironmentMap::EnvironmentMap(std::shared_ptr<const EnvironmentImage> image)
    : _image(std::move(image))
{
    const int width = _image->width, height = _image->height;
    _blocksPerRow = (width + kBlock - 1) / kBlock;
    _rowZ.resize(static_cast<std::size_t>(height) + 1);
    for (int y = 0; y <= height; ++y)
        _rowZ[static_cast<std::size_t>(y)] = -std::cos(kTwoPi * 0.5 * y / height);
    for (int y = 0; y < height; ++y)
    {
        Vec3d sum(0.0);
        for (int x = 0; x < width; ++x)
            sum += Vec3d(row(y)[x]);
        _integral += sum * solidAngle(y);
    }
    _luminance = sumsOver(0.0);
    _compensated = sumsOver(_luminance.integral / (2.0 * kTwoPi));
    // What rounding leaves of an even sky is no distribution.
    if (!(_compensated.integral > kLeastUneven * _luminance.integral)) _compensated = {};
}

/// Sums are double: float sums of a bright pixel and of dim ones would lose the dim ones.
EnvironmentMap::Sums EnvironmentMap::sumsOver(double floor) const
{
    const int width = _image->width, height = _image->height;
    Sums sums;
    sums.floor = floor;
    sums.rows.reserve(static_cast<std::size_t>(height));
    sums.blocks.reserve(static_cast<std::size_t>(height) * static_cast<std::size_t>(_blocksPerRow));
    for (int y = 0; y < height; ++y)
    {
        double weights = 0.0;
        for (int x = 0; x < width; ++x)
        {
            weights += weightOf(row(y)[x], floor);
            if (x % kBlock == kBlock - 1 || x == width - 1) sums.blocks.push_back(weights);
        }
        sums.rows.push_back(sums.integral += weights * solidAngle(y));
    }
    return sums;
}

double EnvironmentMap::solidAngle(int row) const
{
    const auto y = static_cast<std::size_t>(row);
    return kTwoPi / _image->width * (_rowZ[y + 1] - _rowZ[y]);
}

Vec3d EnvironmentMap::direction(double x, double y) const
{
    const double azimuth = (x / _image->width - 0.5) * kTwoPi;
    const double elevation = (y / _image->height - 0.5) * 0.5 * kTwoPi;
    const double across = std::cos(elevation);
    return Vec3d(across * std::sin(azimuth), across * std::cos(azimuth), std::sin(elevation));
}

EnvironmentSample EnvironmentMap::sample(float u, float v, EnvironmentDensity density) const
{
    const Sums& from = sums(density);
    EnvironmentSample sample;
    if (!(from.integral > 0.0)) return sample;

    // The first step chooses the row and the height within it: uniform in z, as solid angle is.
    const double vTarget = v * from.integral;
    const std::size_t y = entryOf(from.rows.data(), from.rows.size(), vTarget);
    const double below = y ? from.rows[y - 1] : 0.0;
    const double inRow = std::clamp((vTarget - below) / (from.rows[y] - below), 0.0, 1.0);
    const double z = _rowZ[y] + inRow * (_rowZ[y + 1] - _rowZ[y]);

    // The second step chooses the block of pixels, then the pixel.
    const double* blocks = &from.blocks[y * static_cast<std::size_t>(_blocksPerRow)];
    const auto blockCount = static_cast<std::size_t>(_blocksPerRow);
    const double uTarget = u * blocks[blockCount - 1];
    const std::size_t block = entryOf(blocks, blockCount, uTarget);
    const auto width = static_cast<std::size_t>(_image->width);
    const Vec3* pixels = row(static_cast<int>(y));
    double left = block ? blocks[block - 1] : 0.0, weight = 0.0;
    std::size_t x = block * kBlock;
    for (std::size_t at = x; at < std::min(width, (block + 1) * kBlock); ++at)
    {
        const double next = weightOf(pixels[at], from.floor);
        if (!(next > 0.0)) continue;
        left += weight;
        weight = next;
        x = at;
        if (left + weight > uTarget) break;
    }
    const double inPixel = std::clamp((uTarget - left) / weight, 0.0, 1.0);

    const double azimuth = ((static_cast<double>(x) + inPixel) / _image->width - 0.5) * kTwoPi;
    const double across = std::sqrt(std::max(0.0, (1.0 - z) * (1.0 + z)));
    sample.direction = Vec3(static_cast<float>(across * std::sin(azimuth)),
                            static_cast<float>(across * std::cos(azimuth)), static_cast<float>(z));
    sample.radiance = pixels[x];
    sample.pdfW = static_cast<float>(weight / from.integral);
    return sample;
}

float EnvironmentMap::pdfW(Vec3 direction, EnvironmentDensity density) const
{
    const Sums& from = sums(density);
    if (!(from.integral > 0.0)) return 0.0f;
    return static_cast<float>(weightOf(radiance(direction), from.floor) / from.integral);
}

std::size_t EnvironmentMap::pixelOf(Vec3 direction) const
{
    if (!isFinite(direction)) return 0;
    const Vec2 at = imagePoint(*_image, direction);
    const int x = std::clamp(static_cast<int>(at.x), 0, _image->width - 1);
    const int y = std::clamp(static_cast<int>(at.y), 0, _image->height - 1);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(_image->width) +
           static_cast<std::size_t>(x);
}

/// Returns a pixel; y goes from -1 to height: beyond a pole the image goes on half a turn further.
Vec3 EnvironmentMap::pixelAt(int x, int y) const
{
    const int width = _image->width;
    if (y < 0 || y >= _image->height)
    {
        y = std::clamp(y, 0, _image->height - 1);
        x += width / 2;
    }
    x = (x + 2 * width) % width;
    return _image->radiance[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(x)];
}

Vec3 EnvironmentMap::interpolatedRadiance(Vec3 direction) const
{
    if (!isFinite(direction)) return Vec3(NAN); // the sample is dropped and counted
    const Vec2 at = imagePoint(*_image, direction) - 0.5f;
    const Vec2 low(std::floor(at.x), std::floor(at.y));
    const Vec2 part = at - low;
    const int x = static_cast<int>(low.x), y = static_cast<int>(low.y);
    const Vec3 lower = pixelAt(x, y) * (1.0f - part.x) + pixelAt(x + 1, y) * part.x;
    const Vec3 upper = pixelAt(x, y + 1) * (1.0f - part.x) + pixelAt(x + 1, y + 1) * part.x;
    return lower * (1.0f - part.y) + upper * part.y;
}

} // namespace osgRayTrace::engine
