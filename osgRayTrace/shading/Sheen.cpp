// Sheen.cpp - the lobe of fibres and its albedo by quadrature. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/Sheen.h"

#include "osgRayTrace/base/NeverDestroyed.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the fit of [Estevez17, table 1] between alpha = 0 and alpha = 1.
float fitted(float x, float alpha)
{
    const float t = (1.0f - alpha) * (1.0f - alpha);
    const auto mix = [t](float rough, float smooth) { return rough + (smooth - rough) * t; };
    const float a = mix(21.5473f, 25.3245f), b = mix(3.82987f, 3.32435f);
    const float c = mix(0.19823f, 0.16801f), d = mix(-1.97760f, -1.27393f);
    const float e = mix(-4.32054f, -4.85967f);
    return a / (1.0f + b * std::pow(x, c)) + d * x + e;
}

float lambdaOf(float alpha, float cosTheta)
{
    if (cosTheta < 0.5f) return std::exp(fitted(cosTheta, alpha));
    return std::exp(2.0f * fitted(0.5f, alpha) - fitted(1.0f - cosTheta, alpha));
}

/// Returns D V as the paper has it.
float lobe(float alpha, Vec3 wo, Vec3 wi)
{
    const Vec3 sum = wo + wi;
    const float length2 = glm::dot(sum, sum);
    if (!(length2 > 1e-14f) || !(wo.z > 0.0f) || !(wi.z > 0.0f)) return 0.0f;
    const float sine2 = (sum.x * sum.x + sum.y * sum.y) / length2;
    const float d = (2.0f + 1.0f / alpha) * std::pow(sine2, 0.5f / alpha) * (0.5f * kInvPi);
    const float masking = 1.0f + lambdaOf(alpha, wo.z) + lambdaOf(alpha, wi.z);
    const float value = d / (4.0f * wo.z * wi.z * masking);
    return value < kInfinity ? value : 0.0f;
}

/// Holds albedos over roughness and the square root of the cosine, where they are smooth.
class SheenAlbedo
{
public:
    SheenAlbedo()
    {
        for (int row = 0; row <= kRows; ++row)
            for (int column = 0; column <= kColumns; ++column)
                at(row, column) = albedoOf(roughnessOf(row), cosineOf(column));
    }

    float operator()(float alpha, float cosTheta) const
    {
        const float roughness = std::sqrt(std::max(alpha, 0.0f));
        const float y =
            std::clamp((roughness - kLeastSheenRoughness) / (1.0f - kLeastSheenRoughness) * kRows,
                       0.0f, float(kRows));
        const float x =
            std::clamp(std::sqrt(std::max(cosTheta, 0.0f)) * kColumns, 0.0f, float(kColumns));
        const int row = std::min(static_cast<int>(y), kRows - 1);
        const int column = std::min(static_cast<int>(x), kColumns - 1);
        const float s = x - static_cast<float>(column), t = y - static_cast<float>(row);
        const float low = at(row, column) * (1.0f - s) + at(row, column + 1) * s;
        const float high = at(row + 1, column) * (1.0f - s) + at(row + 1, column + 1) * s;
        return low * (1.0f - t) + high * t;
    }

private:
    static constexpr int kRows = 24, kColumns = 48;

    static float roughnessOf(int row)
    {
        return kLeastSheenRoughness + (1.0f - kLeastSheenRoughness) * float(row) / kRows;
    }
    static float cosineOf(int column)
    {
        const float x = static_cast<float>(column) / kColumns;
        return std::max(x * x, 1e-4f);
    }

    /// Returns the integral of D V |wi.z| over the directions wi, by the midpoint rule in the
    /// square root of wi.z, as the lobe is steep at grazing angles.
    static float albedoOf(float roughness, float cosine)
    {
        constexpr int kHeights = 32, kTurns = 24;
        const Vec3 wo(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
        double sum = 0.0;
        for (int j = 0; j < kHeights; ++j)
        {
            const float x = (static_cast<float>(j) + 0.5f) / kHeights, z = x * x;
            const float sine = std::sqrt(1.0f - z * z);
            for (int i = 0; i < kTurns; ++i)
            {
                const float phi = kPi * (static_cast<float>(i) + 0.5f) / kTurns;
                const Vec3 wi(sine * std::cos(phi), sine * std::sin(phi), z);
                sum += double(lobe(roughness * roughness, wo, wi)) * z * 2.0 * x;
            }
        }
        return static_cast<float>(sum * 2.0 * M_PI / (kHeights * kTurns));
    }

    float& at(int row, int column)
    {
        return _values[static_cast<std::size_t>(row * (kColumns + 1) + column)];
    }
    float at(int row, int column) const
    {
        return _values[static_cast<std::size_t>(row * (kColumns + 1) + column)];
    }

    std::array<float, (kRows + 1) * (kColumns + 1)> _values{};
};

} // namespace

namespace
{

/// Returns the albedo without a limit.
float albedoOf(float alpha, float cosTheta)
{
    static const NeverDestroyed<SheenAlbedo> table;
    return (*table)(alpha, cosTheta);
}

constexpr float kTableError = 1.03f; ///< the table is less than 3 % off where it is above 0.9

} // namespace

float evalSheen(float alpha, Vec3 wo, Vec3 wi)
{
    const float value = lobe(alpha, wo, wi);
    if (!(value > 0.0f)) return 0.0f;
    const float albedo = std::max(albedoOf(alpha, wo.z), albedoOf(alpha, wi.z));
    return value / std::max(1.0f, kTableError * albedo);
}

float sheenAlbedo(float alpha, float cosTheta)
{
    return std::min(albedoOf(alpha, cosTheta), 1.0f);
}

} // namespace osgRayTrace::engine
