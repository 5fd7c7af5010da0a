// SurfaceTangents.cpp - tangents of meshes and of triangles. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/SurfaceTangents.h"

#include "osgRayTrace/accel/NormalMaps.h"
#include "osgRayTrace/accel/VertexTangents.h"
#include "osgRayTrace/sampling/Warp.h"
#include "osgRayTrace/shading/LayeredBsdf.h"

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

/// Returns a tangent of the mesh's space in engine space.
Tangent placedTangent(const SurfaceRecord& record, Vec4 mean)
{
    Tangent tangent{Vec3(mean), mean.w < 0.0f ? -1.0f : 1.0f};
    if (!record.placed) return tangent;
    tangent.direction = record.placed->engineFromLocal.linear * tangent.direction;
    if (record.placed->mirrored) tangent.w = -tangent.w;
    return tangent;
}

Tangent meanTangent(const SurfaceRecord& record, const Vec4* tangents, UVec3 t, float u, float v)
{
    return placedTangent(record,
                         tangents[t.x] * (1.0f - u - v) + tangents[t.y] * u + tangents[t.z] * v);
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

/// Returns the tangent at a point: the mesh's own, the one that was made for its vertices, or that
/// of the flat triangle.
static Tangent tangentAt(const TracedScene& traced, const TrianglePoint& point, uint32_t uvSet,
                         Vec3 normal)
{
    const SurfaceRecord record = traced.surfaces()[point.instance];
    const UVec3 t = record.triangles[point.primitive];
    if (record.tangents) return meanTangent(record, record.tangents, t, point.u, point.v);
    const VertexTangents* made = traced.vertexTangents(point.instance, uvSet);
    if (!made) return tangentOfTriangle(record, t, record.uvsOfSet(uvSet), normal);
    const UVec3 own = made->triangles[point.primitive];
    if (own.x == kInvalid || own.y == kInvalid || own.z == kInvalid) return {};
    return meanTangent(record, made->tangents.data(), own, point.u, point.v);
}

std::optional<SurfaceAxes> surfaceAxes(const TracedScene& traced, const TrianglePoint& point,
                                       uint32_t uvSet, Vec3 normal)
{
    Tangent tangent = tangentAt(traced, point, uvSet, normal);
    tangent.direction -= normal * glm::dot(normal, tangent.direction);
    const float length = glm::length(tangent.direction);
    if (!(length > 0.0f) || !(length < kInfinity)) return std::nullopt;
    const Vec3 x = tangent.direction / length;
    return SurfaceAxes{x, glm::cross(normal, x) * tangent.w};
}

static void alignTangent(const TracedScene& traced, const RayHitBlock& rays,
                         const SurfaceLanes& surface, int i, Vec3 normal, Bsdf& bsdf)
{
    const MaterialDetail& detail = *traced.materials()[surface.material[i]].material->detail;
    const std::optional<SurfaceAxes> axes =
        surfaceAxes(traced, {surface.instance[i], rays.primitive[i], rays.u[i], rays.v[i]},
                    detail.places[kAnisotropyRole].set, laneOf(surface.shadingNormal, i));
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

static void alignCoat(Vec3 coatNormal, Vec3 normal, Bsdf& bsdf)
{
    Vec3 x, y;
    frameOf(normal.x, normal.y, normal.z, x, y);
    const Vec3 local(glm::dot(coatNormal, x), glm::dot(coatNormal, y),
                     glm::dot(coatNormal, normal));
    constexpr float kLeastTilt = 1e-3f; // below that the coat counts as parallel
    bsdf.coatTilted =
        !(local.z > 0.0f && glm::dot(Vec2(local), Vec2(local)) < kLeastTilt * kLeastTilt);
    if (!bsdf.coatTilted) return;
    bsdf.coatNormal = local;
    if (bsdf.diffuse != Vec3(0.0f) || bsdf.diffuseTransmission != Vec3(0.0f))
        bsdf.baseAverage = baseAverageOf(bsdf);
}

void alignLayers(const TracedScene& traced, const RayHitBlock& rays, const SurfaceLanes& surface,
                 int i, Vec3 normal, Bsdf& bsdf)
{
    if (bsdf.isAnisotropic()) alignTangent(traced, rays, surface, i, normal, bsdf);
    if (bsdf.coatTilted) alignCoat(coatNormalOf(traced, rays, surface, i), normal, bsdf);
}

} // namespace osgRayTrace::engine
