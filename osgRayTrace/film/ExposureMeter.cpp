// ExposureMeter.cpp - the exposure that the mean of a picture asks for. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/ExposureMeter.h"

#include "osgRayTrace/film/ToneMap.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace osgRayTrace::engine
{

namespace
{

constexpr double kMiddleGrey = 0.18;
constexpr float kLargestEv = 16.0f;
constexpr double kDarkest = 1.0 / 64.0; ///< what is darker counts as so much of the mean

/// Returns the mean of logarithms of luminances.
double logMean(const std::vector<float>& luminances)
{
    const double count = static_cast<double>(luminances.size());
    double sum = 0.0;
    for (const float luminance : luminances)
        sum += double(luminance);
    const double least = kDarkest * sum / count;
    double logs = 0.0;
    for (const float luminance : luminances)
        logs += std::log(std::max(double(luminance), least));
    return logs / count;
}

} // namespace

std::optional<float> meteredEv(const Film& film, bool displayReferred, int most)
{
    const int tiles = film.tileCount();
    const int used = std::min(tiles, most);
    std::vector<float> luminances;
    for (int k = 0; k < used; ++k)
    {
        const auto tile = static_cast<int>(int64_t(k) * tiles / used);
        if (film.tilePasses(tile) == 0) continue;
        TileRgba values;
        film.mean(tile, values);
        for (int pixel = 0; pixel < kTilePixels; ++pixel)
        {
            const RgbaLanes& block = values[pixel / kLanes];
            const int i = pixel % kLanes;
            const int x = film.tileX(tile) + pixel / kLanes % 4 * 4 + i % 4;
            const int y = film.tileY(tile) + pixel / kLanes / 4 * 4 + i / 4;
            const float alpha = block.a[i];
            if (!(alpha > 0.0f) || x >= film.width() || y >= film.height()) continue;
            Vec3 color = Vec3(block.r[i], block.g[i], block.b[i]) / alpha;
            for (int c = 0; c < 3 && displayReferred; ++c)
                color[c] = linearFromSrgb(color[c]);
            const float light = luminance(color);
            if (light > 0.0f && std::isfinite(light)) luminances.push_back(light);
        }
    }
    if (luminances.empty()) return std::nullopt;
    const double mean = std::exp(logMean(luminances));
    return std::clamp(static_cast<float>(std::log2(kMiddleGrey / mean)), -kLargestEv, kLargestEv);
}

float EasedExposure::follow(float reading)
{
    if (!_value) _value = reading;
    const float difference = reading - *_value;
    // A change that has begun goes on until it cannot be seen any more.
    _moving = std::fabs(difference) > (_moving ? 0.1f * kTolerance : kTolerance);
    if (_moving) *_value += kStep * difference;
    return *_value;
}

} // namespace osgRayTrace::engine
