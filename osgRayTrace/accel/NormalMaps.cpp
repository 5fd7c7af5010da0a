// NormalMaps.cpp - tangents, and normals along them. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/NormalMaps.h"

#include "osgRayTrace/accel/SurfaceAttributes.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kLeastSine = 0.01f; ///< of mirrored rays above the facet

/// Holds a direction and the sense of the second axis: w cross(normal, tangent).
struct Tangent
{
    Vec3 direction{0.0f}; ///< of any length, engine space; 0: there is none
    float w = 1.0f;
};

Vec3 placedPoint(const SurfaceRecord& record, uint32_t vertex)
{
    const Vec3 p = record.positions[vertex];
    return record.placed ? transformPoint(record.placed->engineFromLocal, p) : p;
}

Tangent tangentOfMesh(const SurfaceRecord& record, UVec3 t, float u, float v)
{
    const Vec4 mean =
        record.tangents[t.x] * (1.0f - u - v) + record.tangents[t.y] * u + record.tangents[t.z] * v;
    Tangent tangent{Vec3(mean), mean.w < 0.0f ? -1.0f : 1.0f};
    if (!record.placed) return tangent;
    tangent.direction = record.placed->engineFromLocal.linear * tangent.direction;
    if (record.placed->mirrored) tangent.w = -tangent.w;
    return tangent;
}

/// Returns the direction in which s grows [Lengyel01], and the sense by that in which t grows.
Tangent tangentOfTriangle(const SurfaceRecord& record, UVec3 t, const Vec2* uvs, Vec3 normal)
{
    if (!uvs) return {};
    const Vec3 a = placedPoint(record, t.x);
    const Vec3 b = placedPoint(record, t.y) - a, c = placedPoint(record, t.z) - a;
    const Vec2 p = uvs[t.y] - uvs[t.x], q = uvs[t.z] - uvs[t.x];
    const float area = p.x * q.y - p.y * q.x;
    if (!(std::fabs(area) > 0.0f)) return {};
    const float sign = area < 0.0f ? -1.0f : 1.0f;
    const Vec3 alongS = (b * q.y - c * p.y) * sign, alongT = (c * p.x - b * q.x) * sign;
    return {alongS, glm::dot(glm::cross(normal, alongS), alongT) < 0.0f ? -1.0f : 1.0f};
}

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
    const UVec3 t = record.triangles[rays.primitive[i]];
    const float u = rays.u[i], v = rays.v[i];
    const Vec3 normal = laneOf(surface.shadingNormal, i);
    const bool second = material.material->detail->places[kNormalRole].set == 1;
    Tangent tangent = record.tangents
                          ? tangentOfMesh(record, t, u, v)
                          : tangentOfTriangle(record, t, second ? record.uvs1 : record.uvs, normal);
    tangent.direction -= normal * glm::dot(normal, tangent.direction);
    const float length = glm::length(tangent.direction);
    if (!(length > 0.0f) || !(length < kInfinity)) return;
    const Vec3 x = tangent.direction / length, y = glm::cross(normal, x) * tangent.w;

    const RayBlock& ray = rays.ray;
    const Vec3 direction(ray.directionX[i], ray.directionY[i], ray.directionZ[i]);
    const bool front = (surface.front >> i) & 1u;
    const MaterialPoint point =
        materialPointOf(record, material, rays.primitive[i], u, v, front, direction);
    const Vec3 mapped = traced.materials().mappedNormal(*material.material, point);
    const Vec3 sum = x * mapped.x + y * mapped.y + normal * mapped.z;
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
