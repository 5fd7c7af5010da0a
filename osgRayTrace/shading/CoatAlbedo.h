// CoatAlbedo.h - what a rough dielectric interface reflects in all directions together. Layer:
// shading. SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <array>
#include <cmath>
#include <memory>
#include <mutex>

namespace osgRayTrace::engine
{

/// Directional albedo E(cos) of GGX reflection with the Fresnel factor of a dielectric, single
/// scattering, and its average Eavg = 2 int E(c) c dc. A base under such a coat that is scaled by
/// (1 - E(wo)) (1 - E(wi)) / (1 - Eavg) is reciprocal and takes what the coat leaves, no more
/// [Kelemen01, sect. 3].
struct CoatAlbedoRow
{
    static constexpr int kSteps = 64;       ///< nodes are squares of steps: steep at grazing angles
    std::array<float, kSteps + 2> albedo{}; ///< the last one twice
    float average = 0.0f;

    float operator()(float cosTheta) const
    {
        const float x = std::sqrt(std::fmin(std::fmax(cosTheta, 0.0f), 1.0f)) * kSteps;
        const int i = static_cast<int>(x);
        const float low = albedo[static_cast<std::size_t>(i)];
        return low + (albedo[static_cast<std::size_t>(i) + 1] - low) * (x - static_cast<float>(i));
    }
};

/// Rows of one index by roughness, made where they are asked for.
class CoatAlbedo
{
public:
    /// The table of an index, shared by all that use it at the same time. Thread safe.
    static std::shared_ptr<CoatAlbedo> ofIndex(float eta);

    explicit CoatAlbedo(float eta) : _eta(eta) {}

    /// Makes the rows around a roughness = sqrt(alpha) in [0, 1], or all. Thread safe: those that
    /// are made do not change.
    void prepare(float roughness);
    void prepareAll();

    struct Place
    {
        const CoatAlbedoRow* rows = nullptr; ///< two neighbours
        float fraction = 0.0f;               ///< from the first to the second
    };
    /// Of a roughness whose rows are prepared.
    Place at(float roughness) const;

private:
    static constexpr int kRoughnessSteps = 64;

    void makeRow(int row);

    float _eta;
    std::mutex _mutex; ///< of those who make rows
    std::array<CoatAlbedoRow, kRoughnessSteps + 1> _rows;
    std::array<bool, kRoughnessSteps + 1> _made{};
};

} // namespace osgRayTrace::engine
