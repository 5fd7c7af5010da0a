// Fresnel.cpp - the mean reflectance of an interface, by quadrature. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/Fresnel.h"

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

} // namespace osgRayTrace::engine
