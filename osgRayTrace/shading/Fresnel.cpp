// Fresnel.cpp - mean reflectances by quadrature, and refracted directions. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/Fresnel.h"

#include <algorithm>

namespace osgRayTrace::engine
{

float fresnelDielectricAverage(float eta)
{
    if (eta == 1.0f) return 0.0f;
    // The midpoint rule is applied in x = c^2, in which the integral is int F dx, refined towards
    // grazing by x = s^2.
    constexpr int kSteps = 256;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
    {
        const double s = (i + 0.5) / kSteps;
        sum += fresnelDielectric(static_cast<float>(s), eta) * 2.0 * s;
    }
    return static_cast<float>(sum / kSteps);
}

std::optional<Vec3> refract(Vec3 wo, Vec3 h, float eta)
{
    if (eta == 1.0f) return -wo; // covers 1 - cosI^2 that rounds to 1 as well
    const float cosI = glm::dot(wo, h);
    const float sin2T = std::max(0.0f, 1.0f - cosI * cosI) / (eta * eta);
    if (sin2T >= 1.0f) return std::nullopt;
    const float cosT = std::sqrt(1.0f - sin2T);
    return glm::normalize(-wo / eta + h * (cosI / eta - cosT));
}

} // namespace osgRayTrace::engine
