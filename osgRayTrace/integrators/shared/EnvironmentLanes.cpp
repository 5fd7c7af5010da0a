// EnvironmentLanes.cpp - environment samples of a block of surface points. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/EnvironmentLanes.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kUniformPdfW = 0.25f * kInvPi; // [1/sr]

/// Returns a uniform sample of the sphere. Neighbouring points of the square give neighbouring
/// directions.
EnvironmentSample uniformSample(const PlacedEnvironment& environment, float u, float v)
{
    EnvironmentSample sample;
    const float z = 1.0f - 2.0f * v;
    const float across = 2.0f * std::sqrt(std::max(0.0f, v * (1.0f - v)));
    float sine, cosine;
    sinCosTurn(u, sine, cosine);
    sample.direction = Vec3(across * cosine, across * sine, z);
    sample.radiance = environment.radiance(sample.direction);
    sample.pdfW = kUniformPdfW;
    return sample;
}

/// Sets the sample of lane i. Returns false if the surface gets no light from direction wi.
bool setLane(const SurfaceLanes& surface, int i, Vec3 wi, bool transmissive, Vec3 radiance,
             float weight, LightLanes& samples)
{
    if (!transmissive && glm::dot(laneOf(surface.geometricNormal, i), wi) <= 0.0f) return false;
    setSample(samples, i, wi, radiance, weight);
    setRay(samples.shadow, i, leave(surface, i, wi), wi, kInfinity);
    return true;
}

} // namespace

SkySample sampleSky(const PassContext& context, const PlacedEnvironment& environment, Vec2 u,
                    bool alone)
{
    const bool uniform = context.options.environmentSampling == EnvironmentSampling::Uniform;
    const EnvironmentDensity density =
        alone ? EnvironmentDensity::Luminance : EnvironmentDensity::Compensated;
    const EnvironmentSample sample =
        uniform ? uniformSample(environment, u.x, u.y) : environment.sample(u.x, u.y, density);
    return {sample.direction, sample.radiance, sample.pdfW};
}

void environmentLanes(const PassContext& context, const LightReceivers& receivers, LaneMask alone,
                      LightLanes& samples)
{
    const PlacedEnvironment& environment = *context.traced->lights().environment();
    const bool uniform = context.options.environmentSampling == EnvironmentSampling::Uniform;
    const LaneMask transmissive = receivers.throughSurface | receivers.surface.terminatorLanes;
    samples.lit = 0;
    for (const int i : lanesIn(receivers.active))
    {
        const float u = receivers.u[i], v = receivers.v[i];
        const EnvironmentDensity density =
            (alone >> i) & 1u ? EnvironmentDensity::Luminance : EnvironmentDensity::Compensated;
        const EnvironmentSample sample =
            uniform ? uniformSample(environment, u, v) : environment.sample(u, v, density);
        if (!(sample.pdfW > 0.0f)) continue;
        const bool lit = setLane(receivers.surface, i, sample.direction, (transmissive >> i) & 1u,
                                 sample.radiance, 1.0f / sample.pdfW, samples);
        samples.lit |= static_cast<LaneMask>(lit) << i;
    }
}

void stratumLanes(const EnvironmentStratum& stratum, float inversePmf, const SurfaceLanes& surface,
                  LaneMask active, LaneMask transmissive, LightLanes& samples)
{
    transmissive |= surface.terminatorLanes;
    samples.lit = 0;
    for (const int i : lanesIn(active))
    {
        const bool lit = setLane(surface, i, stratum.direction, (transmissive >> i) & 1u,
                                 stratum.integral, inversePmf, samples);
        samples.lit |= static_cast<LaneMask>(lit) << i;
    }
}

float environmentPdfW(const PassContext& context, const PlacedEnvironment& environment,
                      Vec3 direction)
{
    const bool uniform = context.options.environmentSampling == EnvironmentSampling::Uniform;
    return uniform ? kUniformPdfW : environment.pdfW(direction, EnvironmentDensity::Compensated);
}

Vec3 radianceBehind(const PassContext& context, const RayBlock& ray, int i)
{
    const PlacedEnvironment* environment = context.traced->lights().environment();
    if (!environment) return Vec3(context.traced->scene().background);
    return environment->seenRadiance(directionOf(ray, i));
}

const PlacedEnvironment* visibleEnvironment(const PassContext& context)
{
    const PlacedEnvironment* environment = context.traced->lights().environment();
    return environment && environment->isVisible() ? environment : nullptr;
}

} // namespace osgRayTrace::engine
