// LayerAverages.cpp - means and bounds over angles of what layers leave. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LayeredBsdf.h"
#include "osgRayTrace/shading/LayeredTerms.h"

namespace osgRayTrace::engine
{

float baseAverageOf(const Bsdf& b)
{
    constexpr int kSteps = 64;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
    {
        // The integral is int A dx with x = c^2, refined towards grazing by x = s^2.
        const double s = (i + 0.5) / kSteps;
        sum += aboveBase(b, static_cast<float>(s)) * 2.0 * s;
    }
    return static_cast<float>(std::max(sum / kSteps, 1e-6));
}

float filmRiseOf(const Bsdf& b)
{
    constexpr int kSteps = 32;
    float rise = 0.0f;
    for (int i = 0; i <= kSteps; ++i)
    {
        const float cosTheta = static_cast<float>(i) / kSteps;
        const Vec3 bare = tinted(b, fresnelDielectric(cosTheta, b.eta));
        const Vec3 added = withFilm(b, cosTheta, bare) - bare, left = Vec3(1.0f) - bare;
        for (int c = 0; c < 3; ++c)
            if (left[c] > 0.0f) rise = std::max(rise, added[c] / left[c]);
    }
    return std::min(rise, 1.0f);
}

Vec3 straightTransmittance(const Bsdf& b, float cosTheta)
{
    if (!b.thin || !b.isSmooth() || !b.transmits()) return Vec3(0.0f);
    return b.transmission * (Vec3(1.0f) - interfaceFresnel(b, cosTheta)) *
           passedLayers(b, cosTheta, cosTheta);
}

} // namespace osgRayTrace::engine
