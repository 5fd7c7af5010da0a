// NormalMaps.cpp - normals along tangents. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/NormalMaps.h"

#include "osgRayTrace/accel/SurfaceAttributes.h"
#include "osgRayTrace/accel/SurfaceTangents.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kLeastSine = 0.01f; ///< of mirrored rays above the facet

/// Returns the normal nearest to n that is seen along the direction from the side of the facet, and
/// mirrors it to that side.
Vec3 visible(Vec3 n, Vec3 facet, Vec3 direction)
{
    const Vec3 wo = -direction;
    const Vec3 mirrored = n * (2.0f * glm::dot(n, wo)) - wo;
    const float height = glm::dot(mirrored, facet);
    if (glm::dot(n, wo) > 0.0f && height >= kLeastSine) return n;
    const Vec3 lifted = glm::normalize(mirrored + facet * (kLeastSine - height));
    return glm::normalize(wo + lifted);
}

void applyAt(const TracedScene& traced, const RayHitBlock& rays, int i, SurfaceLanes& surface)
{
    const uint32_t number = surface.material[i];
    const MaterialRecord& material = traced.materials()[number];
    const SurfaceRecord record = traced.surfaces()[surface.instance[i]];
    const float u = rays.u[i], v = rays.v[i];
    const Vec3 normal = laneOf(surface.shadingNormal, i);
    const bool second = material.material->detail->places[kNormalRole].set == 1;
    const std::optional<SurfaceAxes> axes =
        surfaceAxes(record, {rays.primitive[i], u, v}, second, normal);
    if (!axes) return;

    const RayBlock& ray = rays.ray;
    const Vec3 direction(ray.directionX[i], ray.directionY[i], ray.directionZ[i]);
    const bool front = (surface.front >> i) & 1u;
    const MaterialPoint point =
        materialPointOf(record, material, rays.primitive[i], u, v, front, direction);
    const Vec3 mapped = traced.materials().mappedNormal(*material.material, point);
    const Vec3 sum = axes->tangent * mapped.x + axes->bitangent * mapped.y + normal * mapped.z;
    const float size = glm::length(sum);
    if (!(size > 1e-6f) || !(size < kInfinity)) return;
    const Vec3 facet = laneOf(surface.geometricNormal, i);
    const float side = glm::dot(normal, facet) < 0.0f ? -1.0f : 1.0f;
    const Vec3 result = visible(sum * (side / size), facet, direction) * side;
    if (isFinite(result)) setLane(surface.shadingNormal, i, result);
}

} // namespace

void applyNormalMaps(const TracedScene& traced, const RayHitBlock& rays, SurfaceLanes& surface)
{
    const MaterialTable& materials = traced.materials();
    for (const int i : lanesIn(surface.hits))
        if (materials[surface.material[i]].normalMap) applyAt(traced, rays, i, surface);
}

} // namespace osgRayTrace::engine
