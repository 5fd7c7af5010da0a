// ShadowLanes.cpp - light samples of a block of surface points and their shadow rays. Layer:
// integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/ShadowLanes.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/shading/SoftLight.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// From here on no terminator offset changes the direction to a light, and squares of distances are
/// no floats.
constexpr float kFarLight = 1e18f;

/// A parallelogram with what all lanes share.
struct Quad
{
    Vec3 corner, edgeU, edgeV, normal;
    float area;
    float offset; ///< error bound of a point on it
    bool twoSided;
    Vec3 radiance;
};

Quad quadOf(const Light& light, const LightTable& table, uint32_t index)
{
    return {light.corner,        light.edgeU,       light.edgeV,
            table.normal(index), table.area(index), table.pointOffset(index),
            light.twoSided,      light.radiance};
}

OSGRAYTRACE_KERNEL
LaneMask quadLanes(const Quad& quad, float pmf, const SurfaceLanes& surface, LaneMask active,
                   LaneMask transmissive, const FloatLanes& u, const FloatLanes& v,
                   LightLanes& samples)
{
    const Quad q = quad;
    const float inversePmf = 1.0f / pmf;
    LaneMask lit = 0;
    OSGRAYTRACE_SIMD_OR(lit)
    for (int i = 0; i < kLanes; ++i)
    {
        const float px = surface.position.x[i], py = surface.position.y[i],
                    pz = surface.position.z[i];
        const float nx = surface.geometricNormal.x[i], ny = surface.geometricNormal.y[i],
                    nz = surface.geometricNormal.z[i];
        const float lx = q.corner.x + u[i] * q.edgeU.x + v[i] * q.edgeV.x;
        const float ly = q.corner.y + u[i] * q.edgeU.y + v[i] * q.edgeV.y;
        const float lz = q.corner.z + u[i] * q.edgeU.z + v[i] * q.edgeV.z;

        // Which side of the light the point is on, and which side of the surface the light is on.
        const float towardsX = px - lx, towardsY = py - ly, towardsZ = pz - lz;
        const float height = towardsX * q.normal.x + towardsY * q.normal.y + towardsZ * q.normal.z;
        const float lightSide = select(height >= 0.0f, q.offset, -q.offset);
        const float above = -(towardsX * nx + towardsY * ny + towardsZ * nz);
        const float offset = surface.offset[i];
        const float surfaceSide = select(above >= 0.0f, offset, -offset);

        const float ox = px + nx * surfaceSide, oy = py + ny * surfaceSide,
                    oz = pz + nz * surfaceSide;
        const float dx = lx + q.normal.x * lightSide - ox;
        const float dy = ly + q.normal.y * lightSide - oy;
        const float dz = lz + q.normal.z * lightSide - oz;
        const float distance = std::sqrt(dx * dx + dy * dy + dz * dz);
        const float perDistance = 1.0f / distance;

        // The shadow ray is moved off both surfaces; the geometry term is not, or the light of
        // large surfaces would be wrong by their error bound.
        const float inverse =
            1.0f / std::sqrt(towardsX * towardsX + towardsY * towardsY + towardsZ * towardsZ);
        const float wx = -towardsX * inverse, wy = -towardsY * inverse, wz = -towardsZ * inverse;
        samples.wi.x[i] = wx;
        samples.wi.y[i] = wy;
        samples.wi.z[i] = wz;

        const float cosL = -(wx * q.normal.x + wy * q.normal.y + wz * q.normal.z);
        const float cosine = select(q.twoSided, std::fabs(cosL), cosL);
        const float weight = cosine * q.area * inverse * inverse;
        samples.weight[i] = weight * inversePmf;
        const uint32_t reachable = maskOf(above > 0.0f) | laneBit(transmissive, i);
        lit |= bitOfLane(maskOf(weight > 0.0f) & maskOf(weight < 1e30f) & reachable, i);
        samples.radiance[0][i] = q.radiance.x;
        samples.radiance[1][i] = q.radiance.y;
        samples.radiance[2][i] = q.radiance.z;
        setRay(samples.shadow, i, ox, oy, oz, dx * perDistance, dy * perDistance, dz * perDistance,
               distance);
    }
    return lit & active;
}

/// A lane whose light sample is on an emissive mesh.
bool meshLane(const PassContext& context, uint32_t light, float pmf, const SurfaceLanes& surface,
              int i, float u, float v, bool transmissive, LightLanes& samples)
{
    const LightTable& table = context.traced->lights();
    const Vec3 p = laneOf(surface.position, i);
    const std::optional<AreaLightSample> sample = table.sampleArea(light, p, u, v);
    if (!sample) return false;
    const Vec3 n = laneOf(surface.geometricNormal, i);
    if (!transmissive && glm::dot(n, sample->wi) <= 0.0f) return false;

    // Measured from where the ray starts, as the path tracer does when it meets the light by
    // chance: far from the origin that is not where the surface is, and densities that disagree
    // would weight light twice.
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
    const Instance& instance = context.traced->scene().instances[(*context.lights)[light].instance];
    MaterialPoint point;
    point.uv = sample->uv;
    const Vec3 radiance = context.traced->materials().emission(instance.material, point);
    setSample(samples, i, wi, radiance, 1.0f / (pmf * pdfW));
    return true;
}

} // namespace

void areaLightLanes(const PassContext& context, uint32_t index, float pmf,
                    const SurfaceLanes& surface, LaneMask active, LaneMask transmissive,
                    const FloatLanes& u, const FloatLanes& v, LightLanes& samples)
{
    const Light& light = (*context.lights)[index];
    transmissive |= surface.terminatorLanes;
    if (light.kind == LightKind::Parallelogram)
    {
        samples.lit = quadLanes(quadOf(light, context.traced->lights(), index), pmf, surface,
                                active, transmissive, u, v, samples);
        return;
    }
    samples.lit = 0;
    for (const int i : lanesIn(active))
    {
        if (meshLane(context, index, pmf, surface, i, u[i], v[i], (transmissive >> i) & 1u,
                     samples))
            samples.lit |= 1u << i;
    }
}

void deltaLightLanes(const PassContext& context, uint32_t index, const SurfaceLanes& surface,
                     LaneMask active, LaneMask transmissive, const FloatLanes& u,
                     const FloatLanes& v, LightLanes& samples)
{
    const Light& light = (*context.lights)[index];
    const bool soft = isSoft(light);
    transmissive |= surface.terminatorLanes;
    samples.lit = 0;
    for (const int i : lanesIn(active))
    {
        const Material& material = context.traced->scene().materials[surface.material[i]];
        if (!isLightEnabled(material, light.number)) continue;
        const Vec3 point = laneOf(trianglePoints(surface), i);
        const SoftLightSample sample =
            sampleSoft(light, point, soft ? Vec2(u[i], v[i]) : Vec2(0.0f));
        if (!(sample.attenuation > 0.0f)) continue;
        if (!((transmissive >> i) & 1u) &&
            glm::dot(laneOf(surface.geometricNormal, i), sample.wi) <= 0.0f)
            continue;
        const RayBegin begin = leave(surface, i, sample.wi);
        Vec3 towards = sample.wi;
        float distance = sample.distance;
        if (((surface.terminatorLanes >> i) & 1u) && distance < kFarLight)
        {
            // The terminator offset is no small thing: to the light itself, not past it.
            towards = point + sample.wi * distance - begin.origin;
            distance = glm::length(towards);
            if (!(distance > 0.0f)) continue;
            towards /= distance;
        }
        setRay(samples.shadow, i, begin, towards, std::max(begin.tNear, distance));
        setSample(samples, i, sample.wi, light.diffuse * (kPi * sample.attenuation), sample.weight);
        samples.attenuation[i] = sample.attenuation;
        samples.lit |= 1u << i;
    }
}

OSGRAYTRACE_KERNEL
static LaneMask unoccluded(const RayBlock& shadow)
{
    LaneMask visible = 0;
    OSGRAYTRACE_SIMD_OR(visible)
    for (int i = 0; i < kLanes; ++i)
        visible |= bitOfLane(maskOf(shadow.tFar[i] >= 0.0f), i);
    return visible;
}

LaneMask visibleLanes(const PassContext& context, LightLanes& samples, TileCounts& counts)
{
    if (!context.options.shadows || !samples.lit) return samples.lit;
    context.traced->intersector().occlusion(samples.shadow, samples.lit);
    counts.shadowRays += static_cast<uint64_t>(countLanes(samples.lit));
    return unoccluded(samples.shadow) & samples.lit;
}

LaneMask visibleLanes(const PassContext& context, const Light& light, LightLanes& samples,
                      TileCounts& counts)
{
    return light.castsShadows ? visibleLanes(context, samples, counts) : samples.lit;
}

} // namespace osgRayTrace::engine
