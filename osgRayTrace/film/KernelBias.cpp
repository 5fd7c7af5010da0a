// KernelBias.cpp - the bias of photon look-ups, from discs of three radii. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/KernelBias.h"

#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/sampling/Hash.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

// The bias goes with r^2 where light is smooth, and with r^(1/2) or less at a fold caustic.
constexpr double kSmoothRatio = 0.25, kFoldRatio = 0.7;

/// Products below so many standard errors may be noise.
constexpr double kSignificance = 2.0;

/// A sum of products that is below so many roots of the sum of their squares is that of one tile or
/// two, which a few bright photons can make.
constexpr double kSpread = 1.5;

/// Pixels beside each other share photons of their discs, but none of their footprints, which make
/// most of the noise: the variance of sums over pixels is no more than so many times that of as
/// many independent ones.
constexpr double kSharedPhotons = 4.0;

/// Returns which of a tile's compared blocks a pass compares.
int placeOf(int pass)
{
    return pass / 2 % kComparedBlocks;
}

/// Returns how many of the first passes of a half compared the block at a place.
int visitsOf(int halfPasses, int place)
{
    return (halfPasses + kComparedBlocks - 1 - place) / kComparedBlocks;
}

} // namespace

int comparedBlock(int tile, int pass)
{
    const uint32_t key = hash(static_cast<uint32_t>(tile));
    const auto column = static_cast<uint32_t>(placeOf(pass));
    const uint32_t row = (column * (key & 1u ? 1u : 3u) + (key >> 1)) % kComparedBlocks;
    return static_cast<int>(row * kComparedBlocks + column);
}

void DiscDifferences::add(int pass, const Vec3 (&differences)[kComparedDiscs][kLanes])
{
    for (int disc = 0; disc < kComparedDiscs; ++disc)
        for (int i = 0; i < kLanes; ++i)
            sums[placeOf(pass)][pass & 1][disc][i] += differences[disc][i];
}

BiasProducts biasProducts(const DiscDifferences& differences, int passes, const Vec3d& weights)
{
    OSGRAYTRACE_ASSERT(passes >= 2);
    BiasProducts products;
    int blocks = 0;
    for (int place = 0; place < kComparedBlocks; ++place)
    {
        const int secondVisits = visitsOf(passes / 2, place);
        if (secondVisits == 0) break;
        ++blocks;
        const Vec3d firstScale(1.0 / visitsOf((passes + 1) / 2, place)),
            secondScale(1.0 / secondVisits);
        const auto& [first, second] = differences.sums[place];
        double deviation = 0.0;
        for (int i = 0; i < kLanes; ++i)
        {
            const Vec3d a = Vec3d(first[0][i]) * firstScale, b = Vec3d(second[0][i]) * secondScale;
            const Vec3d nextA = Vec3d(first[1][i]) * firstScale,
                        nextB = Vec3d(second[1][i]) * secondScale;
            products.same += glm::dot(weights, a * b) / kLanes;
            products.next += glm::dot(weights, 0.5 * (a * nextB + b * nextA)) / kLanes;
            deviation += glm::dot(weights, 0.5 * (a - b) * (a - b)) / kLanes;
        }
        products.variance += deviation * deviation;
    }
    products.same /= blocks;
    products.next /= blocks;
    products.variance /= double(blocks) * blocks;
    return products;
}

double squaredBias(const std::vector<BiasProducts>& tiles, const std::vector<double>& pixels)
{
    double same = 0.0, next = 0.0, variance = 0.0, squares = 0.0;
    for (std::size_t t = 0; t < tiles.size(); ++t)
    {
        same += tiles[t].same * pixels[t];
        next += tiles[t].next * pixels[t];
        variance += tiles[t].variance * pixels[t] * pixels[t];
        squares += tiles[t].same * tiles[t].same * pixels[t] * pixels[t];
    }
    const bool seen = same > kSignificance * std::sqrt(variance);
    if (!seen || !(same > kSpread * std::sqrt(squares))) return 0.0;
    const double ratio = std::clamp(next / same, kSmoothRatio, kFoldRatio);
    return same / ((1.0 - ratio) * (1.0 - ratio));
}

void FootprintBias::addPixel(int compared, double sum, double sumOfSquares, double biasedShare)
{
    if (compared < 2) return;
    const double scale = biasedShare * biasedShare / (double(compared) * (compared - 1.0));
    squares += scale * (sum * sum - sumOfSquares);
    variance += 2.0 * scale * scale * sumOfSquares * sumOfSquares;
}

double squaredBias(const std::vector<FootprintBias>& tiles, const std::vector<double>& scales)
{
    double squares = 0.0, variance = 0.0;
    for (std::size_t t = 0; t < tiles.size(); ++t)
    {
        squares += tiles[t].squares * scales[t];
        variance += tiles[t].variance * scales[t] * scales[t];
    }
    return squares > kSignificance * std::sqrt(kSharedPhotons * variance) ? squares : 0.0;
}

} // namespace osgRayTrace::engine
