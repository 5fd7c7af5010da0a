// SurfaceTangents.cpp - tangents of meshes and of triangles. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/SurfaceTangents.h"

#include "osgRayTrace/sampling/Warp.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

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

} // namespace

std::optional<SurfaceAxes> surfaceAxes(const SurfaceRecord& record, const TrianglePoint& point,
                                       bool second, Vec3 normal)
{
    const UVec3 t = record.triangles[point.primitive];
    Tangent tangent = record.tangents
                          ? tangentOfMesh(record, t, point.u, point.v)
                          : tangentOfTriangle(record, t, second ? record.uvs1 : record.uvs, normal);
    tangent.direction -= normal * glm::dot(normal, tangent.direction);
    const float length = glm::length(tangent.direction);
    if (!(length > 0.0f) || !(length < kInfinity)) return std::nullopt;
    const Vec3 x = tangent.direction / length;
    return SurfaceAxes{x, glm::cross(normal, x) * tangent.w};
}

void alignTangent(const TracedScene& traced, const RayHitBlock& rays, const SurfaceLanes& surface,
                  int i, Vec3 normal, Bsdf& bsdf)
{
    const MaterialDetail& detail = *traced.materials()[surface.material[i]].material->detail;
    const std::optional<SurfaceAxes> axes = surfaceAxes(
        traced.surfaces()[surface.instance[i]], {rays.primitive[i], rays.u[i], rays.v[i]},
        detail.places[kAnisotropyRole].set == 1, laneOf(surface.shadingNormal, i));
    if (axes)
    {
        const Vec3 along = axes->tangent * bsdf.tangent.x + axes->bitangent * bsdf.tangent.y;
        Vec3 x, y;
        frameOf(normal.x, normal.y, normal.z, x, y);
        const Vec2 local(glm::dot(along, x), glm::dot(along, y));
        const float length = glm::length(local);
        if (length > 1e-4f)
        {
            bsdf.tangent = local / length;
            return;
        }
    }
    bsdf.alphaTangent = 0.0f;
}

} // namespace osgRayTrace::engine
