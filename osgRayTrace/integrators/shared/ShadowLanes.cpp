// ShadowLanes.cpp - light samples of surface points, and shadow rays. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/ShadowLanes.h"

#include "osgRayTrace/integrators/shared/Panes.h"
#include "osgRayTrace/integrators/shared/QuadLane.h"
#include "osgRayTrace/shading/SoftLight.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// From here on no terminator offset changes directions, and squared distances are no floats.
constexpr float kFarLight = 1e18f;

Quad quadOf(const Light& light, const LightTable& table, uint32_t index)
{
    return {plainOf(light.corner),        plainOf(light.edgeU),   plainOf(light.edgeV),
            plainOf(table.normal(index)), table.area(index),      table.pointOffset(index),
            maskOf(light.twoSided),       plainOf(light.radiance)};
}

OSGRAYTRACE_KERNEL
LaneMask quadLanes(const Quad& quad, float pmf, const LightReceivers& receivers,
                   LaneMask transmissive, LightLanes& samples)
{
    const Quad q = quad;
    const SurfaceLanes& surface = receivers.surface;
    const FloatLanes &u = receivers.u, &v = receivers.v;
    const float inversePmf = 1.0f / pmf;
    LaneMask lit = 0;
    OSGRAYTRACE_SIMD_OR(lit)
    for (int i = 0; i < kLanes; ++i)
        lit |= bitOfLane(quadLane(q, inversePmf, surface, i, laneBit(transmissive, i),
                                  {pointOn(q, u[i], v[i]), 0.0f}, samples),
                         i);
    return lit & receivers.active;
}

OSGRAYTRACE_KERNEL
LaneMask nearLanes(const RectangleLight& light, const SurfaceLanes& surface, float leastAngle)
{
    const RectangleLight rectangle = light;
    const float least = leastAngle;
    LaneMask near = 0;
    OSGRAYTRACE_SIMD_OR(near)
    for (int i = 0; i < kLanes; ++i)
        near |= bitOfLane(mayExceed(rectangle, plainOf(surface.position, i), least), i);
    return near;
}

/// Sets samples as quadLanes does, by solid angle in the lanes from which that is wide.
OSGRAYTRACE_KERNEL
LaneMask rectangleLanes(const Quad& quad, const RectangleLight& light, float pmf,
                        const LightReceivers& receivers, LaneMask transmissive, LightLanes& samples)
{
    const Quad q = quad;
    const RectangleLight rectangle = light;
    const SurfaceLanes& surface = receivers.surface;
    const FloatLanes &u = receivers.u, &v = receivers.v;
    const float inversePmf = 1.0f / pmf;
    LaneMask lit = 0;
    OSGRAYTRACE_SIMD_OR(lit)
    for (int i = 0; i < kLanes; ++i)
        lit |= bitOfLane(
            quadLane(q, inversePmf, surface, i, laneBit(transmissive, i),
                     rectanglePoint(q, rectangle, plainOf(surface.position, i), u[i], v[i]),
                     samples),
            i);
    return lit & receivers.active;
}

/// Sets lane i's sample on an emissive mesh. Returns false if its light cannot reach the surface.
bool meshLane(const PassContext& context, uint32_t light, float pmf,
              const LightReceivers& receivers, int i, LightLanes& samples)
{
    const LightTable& table = context.traced->lights();
    const SurfaceLanes& surface = receivers.surface;
    const bool transmissive = ((receivers.throughSurface | surface.terminatorLanes) >> i) & 1u;
    const Vec3 p = laneOf(surface.position, i);
    const std::optional<AreaLightSample> sample =
        table.sampleArea(light, p, receivers.u[i], receivers.v[i]);
    if (!sample) return false;
    const Vec3 n = laneOf(surface.geometricNormal, i);
    if (!transmissive && glm::dot(n, sample->wi) <= 0.0f) return false;

    // The distance is measured from the start of the ray, as the path tracer measures it when a
    // path meets the light by chance. Far from the origin of space the start is not at the surface,
    // and densities that disagree would weight light twice.
    const RayBegin begin = leave(surface, i, sample->wi);
    const Vec3 d = sample->point - begin.origin;
    const float distance = glm::length(d);
    if (!(distance > 0.0f)) return false;
    const Vec3 wi = d / distance;
    const float cosThetaL = std::fabs(glm::dot(wi, sample->normal));
    const float pdfW = table.pdfArea(light, distance, cosThetaL);
    if (!(cosThetaL > 0.0f) || !(pdfW > 0.0f) || !(pdfW < 1e30f)) return false;
    const float clear = std::max(begin.tNear, distance - sample->offset / cosThetaL);
    setRay(samples.shadow, i, begin, wi, clear);
    const Scene& scene = context.traced->scene();
    const Instance& instance = scene.instances[(*context.lights)[light].instance];
    MaterialPoint point;
    point.setUv(emissionUvSet(scene.materials[instance.material]), sample->uv);
    const Vec3 radiance = context.traced->materials().emission(instance.material, point);
    setSample(samples, i, wi, radiance, 1.0f / (pmf * pdfW));
    return true;
}

} // namespace

void areaLightLanes(const PassContext& context, uint32_t index, float pmf,
                    const LightReceivers& receivers, LightLanes& samples, float leastAngle)
{
    OSGRAYTRACE_ASSERT(index < context.lights->size());
    const Light& light = (*context.lights)[index];
    if (light.kind == LightKind::Parallelogram)
    {
        const LightTable& table = context.traced->lights();
        const LaneMask transmissive = receivers.throughSurface | receivers.surface.terminatorLanes;
        const Quad quad = quadOf(light, table, index);
        const RectangleLight* rectangle = table.rectangle(index);
        const bool near =
            rectangle && (nearLanes(*rectangle, receivers.surface, leastAngle) & receivers.active);
        samples.lit = near ? rectangleLanes(quad, *rectangle, pmf, receivers, transmissive, samples)
                           : quadLanes(quad, pmf, receivers, transmissive, samples);
        return;
    }
    samples.lit = 0;
    for (const int i : lanesIn(receivers.active))
        if (meshLane(context, index, pmf, receivers, i, samples)) samples.lit |= 1u << i;
}

bool deltaLane(const PassContext& context, uint32_t index, const LightReceivers& receivers, int i,
               LightLanes& samples)
{
    const Light& light = (*context.lights)[index];
    const SurfaceLanes& surface = receivers.surface;
    const LaneMask transmissive = receivers.throughSurface | surface.terminatorLanes;
    const Material& material = context.traced->scene().materials[surface.material[i]];
    if (!isLightEnabled(material, light.number)) return false;
    const Vec3 point = laneOf(trianglePoints(surface), i);
    const SoftLightSample sample =
        sampleSoft(light, point, isSoft(light) ? Vec2(receivers.u[i], receivers.v[i]) : Vec2(0.0f));
    if (!(sample.attenuation > 0.0f)) return false;
    if (!((transmissive >> i) & 1u) &&
        glm::dot(laneOf(surface.geometricNormal, i), sample.wi) <= 0.0f)
        return false;
    const RayBegin begin = leave(surface, i, sample.wi);
    Vec3 towards = sample.wi;
    float distance = sample.distance;
    if (((surface.terminatorLanes >> i) & 1u) && distance < kFarLight)
    {
        // The terminator offset is not small: the ray must end at the light, not past it.
        towards = point + sample.wi * distance - begin.origin;
        distance = glm::length(towards);
        if (!(distance > 0.0f)) return false;
        towards /= distance;
    }
    setRay(samples.shadow, i, begin, towards, std::max(begin.tNear, distance));
    setSample(samples, i, sample.wi, light.diffuse * (kPi * sample.attenuation), sample.weight);
    samples.attenuation[i] = sample.attenuation;
    return true;
}

void deltaLightLanes(const PassContext& context, uint32_t index, const LightReceivers& receivers,
                     LightLanes& samples)
{
    OSGRAYTRACE_ASSERT(index < context.lights->size());
    samples.lit = samples.tinted = 0;
    for (const int i : lanesIn(receivers.active))
        if (deltaLane(context, index, receivers, i, samples)) samples.lit |= 1u << i;
}

OSGRAYTRACE_KERNEL
LaneMask unoccludedLanes(const RayBlock& shadow)
{
    LaneMask visible = 0;
    OSGRAYTRACE_SIMD_OR(visible)
    for (int i = 0; i < kLanes; ++i)
        visible |= bitOfLane(maskOf(shadow.tFar[i] >= 0.0f), i);
    return visible;
}

LaneMask visibleLanes(const PassContext& context, LightLanes& samples, TileCounts& counts,
                      Coherence coherence)
{
    if (!context.options.shadows || !samples.lit) return samples.lit;
    if (context.traced->traits().panes)
        return visibleThroughPanes(context, samples, counts, coherence);
    context.traced->intersector().occlusion(samples.shadow, samples.lit, coherence);
    counts.shadowRays += static_cast<uint64_t>(countLanes(samples.lit));
    return unoccludedLanes(samples.shadow) & samples.lit;
}

LaneMask visibleLanes(const PassContext& context, const Light& light, LightLanes& samples,
                      TileCounts& counts, Coherence coherence)
{
    return light.castsShadows ? visibleLanes(context, samples, counts, coherence) : samples.lit;
}

} // namespace osgRayTrace::engine
