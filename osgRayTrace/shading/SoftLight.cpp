// SoftLight.cpp - samples of spheres and suns. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/SoftLight.h"

#include "osgRayTrace/sampling/Warp.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

SoftLightSample sampleSun(const Light& light, Vec2 u)
{
    SoftLightSample sample;
    sample.wi = -softDirection(light, u);
    sample.attenuation = 1.0f;
    sample.weight = softWeight(light.sine);
    return sample;
}

} // namespace

float softWeight(float sine)
{
    return 2.0f / (2.0f - oneMinusCosine(sine));
}

Vec3 softDirection(const Light& light, Vec2 u)
{
    return turnedTo(light.direction, squareToCone(u, oneMinusCosine(light.sine)));
}

Vec3 softOrigin(const Light& light, Vec3 direction, Vec2 u)
{
    float sine, cosine;
    sinCosTurn(u.x, sine, cosine);
    const float radius = light.radius * std::sqrt(u.y);
    return light.position + turnedTo(direction, Vec3(radius * cosine, radius * sine, 0.0f));
}

SoftLightSample sampleSoft(const Light& light, Vec3 p, Vec2 u)
{
    SoftLightSample sample;
    if (!isSoft(light))
    {
        const DeltaLightSample hard = sampleDelta(light, p);
        sample.wi = hard.wi;
        sample.distance = hard.distance;
        sample.attenuation = hard.attenuation;
        return sample;
    }
    if (light.kind == LightKind::Directional) return sampleSun(light, u);

    const Vec3 d = light.position - p;
    // The length is computed in double: far lights of small scenes are so many units away that the
    // square is no float.
    const auto distance = static_cast<float>(glm::length(Vec3d(d)));
    if (!(distance > 0.0f)) return sample;
    const float sine = light.radius / std::max(distance, light.radius);
    const Vec3 local = squareToCone(u, oneMinusCosine(sine));
    sample.wi = turnedTo(d / distance, local);
    sample.distance = distance * local.z;
    sample.attenuation =
        distanceTerm(light, std::max(distance, light.radius)) * spotTerm(light, -sample.wi);
    sample.weight = softWeight(sine);
    if (!(sample.distance > 0.0f)) sample.attenuation = 0.0f;
    return sample;
}

} // namespace osgRayTrace::engine
