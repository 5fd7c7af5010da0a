// CoatAlbedo.h - how much a rough dielectric reflects in all directions together. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/CheckedMutex.h"
#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Math.h"

#include <array>
#include <cmath>
#include <memory>

namespace osgRayTrace::engine
{

constexpr int kCoatSteps =
    64; ///< steps of a row; nodes are squares of steps: dense at grazing angles, where E is steep

/// Returns the albedo interpolated between the nodes of a row. The code has no branches, for loops
/// over lanes.
OSGRAYTRACE_INLINE float coatRowAlbedo(const float* albedo, float cosTheta)
{
    const float c = select(cosTheta > 0.0f, select(cosTheta < 1.0f, cosTheta, 1.0f), 0.0f);
    const float x = std::sqrt(c) * static_cast<float>(kCoatSteps);
    const int i = static_cast<int>(x);
    return albedo[i] + (albedo[i + 1] - albedo[i]) * (x - static_cast<float>(i));
}

/// Returns the same for a row from inside, whose nodes are dense around the cosine at which total
/// reflection ends: E is steep there, and grows as a square root.
OSGRAYTRACE_INLINE float bentRowAlbedo(const float* albedo, float bend, float cosTheta)
{
    const float c = select(cosTheta > 0.0f, select(cosTheta < 1.0f, cosTheta, 1.0f), 0.0f);
    // Half of the steps are below the bend, dense at both ends; half are above it.
    const float s = c / bend, nearest = select(s < 0.5f, s, 1.0f - s);
    const float root = std::sqrt(select(s < 1.0f, 0.5f * nearest, (c - bend) / (1.0f - bend)));
    const float below = select(s < 0.5f, root, 1.0f - root);
    const float x = select(s < 1.0f, below, 1.0f + root) * (0.5f * static_cast<float>(kCoatSteps));
    const int i = static_cast<int>(x);
    return albedo[i] + (albedo[i + 1] - albedo[i]) * (x - static_cast<float>(i));
}

/// Holds the directional albedo E(cos) of GGX reflection with the Fresnel factor of a dielectric,
/// single scattering, and its average Eavg = 2 int E(c) c dc. A base under such a coat is scaled by
/// (1 - E(wo)) (1 - E(wi)) / (1 - Eavg): it is then reciprocal and takes no more than the coat
/// leaves [Kelemen01, sect. 3].
struct CoatAlbedoRow
{
    std::array<float, kCoatSteps + 2> albedo{}; ///< the last value stands twice
    float average = 0.0f;
    float bend = 0.0f; ///< cosine at which total reflection ends; 0: there is none, from outside

    float operator()(float cosTheta) const
    {
        return bend > 0.0f ? bentRowAlbedo(albedo.data(), bend, cosTheta)
                           : coatRowAlbedo(albedo.data(), cosTheta);
    }
};

/// Holds the rows of one index by roughness; each row is made when it is first asked for.
class CoatAlbedo
{
public:
    /// Returns the table of an index, shared by all that use it at the same time. It is thread
    /// safe.
    static std::shared_ptr<CoatAlbedo> ofIndex(float eta);

    explicit CoatAlbedo(float eta) : _eta(eta) {}

    /// Makes the rows around a roughness = sqrt(alpha) in [0, 1], or all. It is thread safe: rows
    /// that are made do not change.
    void prepare(float roughness);
    void prepareAll();

    struct Place
    {
        const CoatAlbedoRow* rows = nullptr; ///< two neighbours
        float fraction = 0.0f;               ///< share of the second row
    };
    /// Returns the rows of a roughness; they have to be prepared.
    Place at(float roughness) const;

private:
    static constexpr int kRoughnessSteps = 64;

    void makeRow(int row);

    float _eta;
    CheckedMutex _mutex; ///< held while rows are made
    std::array<CoatAlbedoRow, kRoughnessSteps + 1> _rows;
    std::array<bool, kRoughnessSteps + 1> _made{};
};

} // namespace osgRayTrace::engine
