// NormalMaps.cpp - normals along tangents. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/NormalMaps.h"

#include "osgRayTrace/accel/SurfaceAttributes.h"
#include "osgRayTrace/accel/SurfaceTangents.h"

#include <cmath>
#include <optional>

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

Vec3 directionOf(const RayBlock& ray, int i)
{
    return {ray.directionX[i], ray.directionY[i], ray.directionZ[i]};
}

/// Returns the sum of the axes at a hit that a normal map of some role asks for, around the normal
/// of the mesh; of any length. Nothing if there is no such map, or no axes.
std::optional<Vec3> mappedAt(const TracedScene& traced, const RayHitBlock& rays,
                             const SurfaceLanes& surface, int i, Vec3 normal, TextureRole role)
{
    const MaterialRecord& material = traced.materials()[surface.material[i]];
    const MaterialDetail& detail = *material.material->detail;
    if (detail.textures[role] == kInvalid) return std::nullopt;
    const SurfaceRecord record = traced.surfaces()[surface.instance[i]];
    const float u = rays.u[i], v = rays.v[i];
    const std::optional<SurfaceAxes> axes = surfaceAxes(
        traced, {surface.instance[i], rays.primitive[i], u, v}, detail.places[role].set, normal);
    if (!axes) return std::nullopt;

    const bool front = (surface.front >> i) & 1u;
    const MaterialPoint point =
        materialPointOf(record, material, rays.primitive[i], u, v, front, directionOf(rays.ray, i));
    const Vec3 mapped = traced.materials().mappedNormal(*material.material, role, point);
    return axes->tangent * mapped.x + axes->bitangent * mapped.y + normal * mapped.z;
}

/// Returns the unit vector of a mapped normal, turned to the side of the facet and seen from there;
/// nothing if it has no direction.
std::optional<Vec3> seen(Vec3 sum, Vec3 normal, Vec3 facet, Vec3 direction)
{
    const float size = glm::length(sum);
    if (!(size > 1e-6f) || !(size < kInfinity)) return std::nullopt;
    const float side = glm::dot(normal, facet) < 0.0f ? -1.0f : 1.0f;
    const Vec3 result = visible(sum * (side / size), facet, direction);
    return isFinite(result) ? std::optional<Vec3>(result) : std::nullopt;
}

void applyAt(const TracedScene& traced, const RayHitBlock& rays, int i, SurfaceLanes& surface)
{
    const Vec3 normal = laneOf(surface.shadingNormal, i);
    const std::optional<Vec3> sum = mappedAt(traced, rays, surface, i, normal, kNormalRole);
    if (!sum) return;
    const Vec3 facet = laneOf(surface.geometricNormal, i);
    const float side = glm::dot(normal, facet) < 0.0f ? -1.0f : 1.0f;
    if (const auto result = seen(*sum, normal, facet, directionOf(rays.ray, i)))
        setLane(surface.shadingNormal, i, *result * side);
}

} // namespace

void applyNormalMaps(const TracedScene& traced, const RayHitBlock& rays, SurfaceLanes& surface)
{
    const MaterialTable& materials = traced.materials();
    surface.unmappedNormal = surface.shadingNormal;
    for (const int i : lanesIn(surface.hits))
        if (materials[surface.material[i]].normalMap) applyAt(traced, rays, i, surface);
}

Vec3 coatNormalOf(const TracedScene& traced, const RayHitBlock& rays, const SurfaceLanes& surface,
                  int i)
{
    const Vec3 normal = laneOf(surface.unmappedNormal, i);
    const Vec3 facet = laneOf(surface.geometricNormal, i);
    const std::optional<Vec3> sum =
        mappedAt(traced, rays, surface, i, normal, kClearcoatNormalRole);
    return seen(sum.value_or(normal), normal, facet, directionOf(rays.ray, i)).value_or(facet);
}

} // namespace osgRayTrace::engine
