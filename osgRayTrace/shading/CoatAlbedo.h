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

/// Returns the same for a row from inside, whose nodes are dense around the cosine of the critical
/// angle: E is steep there, and grows as a square root.
OSGRAYTRACE_INLINE float insideRowAlbedo(const float* albedo, float critical, float cosTheta)
{
    const float c = select(cosTheta > 0.0f, select(cosTheta < 1.0f, cosTheta, 1.0f), 0.0f);
    // Half of the steps are below the critical cosine, dense at both ends; half are above it.
    const float s = c / critical, nearest = select(s < 0.5f, s, 1.0f - s);
    const float root =
        std::sqrt(select(s < 1.0f, 0.5f * nearest, (c - critical) / (1.0f - critical)));
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
    float critical = 0.0f; ///< cosine of the critical angle; 0: there is none, from outside

    float operator()(float cosTheta) const
    {
        return critical > 0.0f ? insideRowAlbedo(albedo.data(), critical, cosTheta)
                               : coatRowAlbedo(albedo.data(), cosTheta);
    }
};

/// Holds what the rows of a table have in common.
struct CoatShape
{
    float eta = 1.0f;
    float anisotropy = 0.0f; ///< strength, as that of PhysicalMaterial; rows then hold the largest
                             ///< albedo over azimuths
    bool varies = false;     ///< true: a texture decides on the strength, up to that one
};

/// Holds the rows of one shape by roughness; each row is made when it is first asked for.
class CoatAlbedo
{
public:
    /// Returns the table of a shape, shared by all that use it at the same time. It is thread safe.
    static std::shared_ptr<CoatAlbedo> ofShape(const CoatShape& shape);

    explicit CoatAlbedo(const CoatShape& shape) : _shape(shape) {}

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

    CoatShape _shape;
    CheckedMutex _mutex; ///< held while rows are made
    std::array<CoatAlbedoRow, kRoughnessSteps + 1> _rows;
    std::array<bool, kRoughnessSteps + 1> _made{};
};

} // namespace osgRayTrace::engine
