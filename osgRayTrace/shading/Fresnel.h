// Fresnel.h - how much an interface reflects, and where the rest goes. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Math.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace osgRayTrace::engine
{

/// Returns the unpolarized reflectance of a dielectric for an angle of incidence with cosine
/// cosThetaI >= 0 [Walter07, eq. 22]; it is 1 on total internal reflection. eta: index on the far
/// side over that on the near side. The code has no branches, for loops over lanes.
OSGRAYTRACE_INLINE float fresnelDielectric(float cosThetaI, float eta)
{
    const float c = std::fabs(cosThetaI);
    // Near the critical angle next to nothing is left of c^2: without double the root of g2 has 3
    // digits.
    const auto g2 =
        static_cast<float>((double(eta) - 1.0) * (double(eta) + 1.0) + double(c) * double(c));
    const float g = std::sqrt(select(g2 > 0.0f, g2, 0.0f));
    // g - c would lose digits for indices near 1: (g^2 - c^2) / (g + c) keeps them.
    const float gMinusC = (eta - 1.0f) * (eta + 1.0f) / (g + c);
    const float a = gMinusC / (g + c);
    const float b = (c * (g + c) - 1.0f) / (c * gMinusC + 1.0f);
    // Next to grazing incidence the mean rounds to more than 1, and 1 - reflectance would be
    // negative.
    const float mean = 0.5f * a * a * (1.0f + b * b);
    const float partial = select(g2 > 0.0f, select(mean < 1.0f, mean, 1.0f), 1.0f);
    return select(eta == 1.0f, 0.0f, partial);
}

/// Returns the reflectance averaged over cosine-weighted incidence: int 2 F(c) c dc, by quadrature
/// to about 1e-4. The average couples a diffuse base to its coat. The function is not for inner
/// loops.
float fresnelDielectricAverage(float eta);

/// Returns how far Schlick's approximation is from normal to grazing incidence, for a cosine >= 0.
OSGRAYTRACE_INLINE float schlickShare(float cosTheta)
{
    const float m = 1.0f - select(cosTheta < 1.0f, cosTheta, 1.0f), m2 = m * m;
    return m2 * m2 * m;
}

/// Returns Schlick's approximation between the reflectances at normal and at grazing incidence
/// [Schlick94, eq. 24].
inline Vec3 fresnelSchlick(float cosTheta, Vec3 f0, float f90)
{
    return f0 + (Vec3(f90) - f0) * schlickShare(std::fmax(cosTheta, 0.0f));
}

/// Returns the direction behind an interface with normal h; nothing on total reflection. eta: index
/// on the far side over that on the near side.
inline std::optional<Vec3> refract(Vec3 wo, Vec3 h, float eta)
{
    if (eta == 1.0f) return -wo; // covers 1 - cosI^2 that rounds to 1 as well
    const float cosI = glm::dot(wo, h);
    const float sin2T = std::max(0.0f, 1.0f - cosI * cosI) / (eta * eta);
    if (sin2T >= 1.0f) return std::nullopt;
    const float cosT = std::sqrt(1.0f - sin2T);
    return glm::normalize(-wo / eta + h * (cosI / eta - cosT));
}

} // namespace osgRayTrace::engine
