// SurfaceAttributes.cpp - interpolates the vertex attributes of meshes. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/SurfaceAttributes.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the interpolated value of a triangle. `values` holds one value a position; if it is
/// null, the mesh has none and the function returns `otherwise`.
template <class Value>
Value interpolate(const SurfaceRecord& record, const Value* values, uint32_t primitive, float u,
                  float v, Value otherwise)
{
    if (!values) return otherwise;
    const UVec3 t = record.triangles[primitive];
    return values[t.x] * (1.0f - u - v) + values[t.y] * u + values[t.z] * v;
}

/// Sets position and normal in engine space, as texture generation needs them.
void setGenerated(const SurfaceRecord& record, uint32_t primitive, float u, float v,
                  MaterialPoint& point)
{
    const UVec3 t = record.triangles[primitive];
    const float w = 1.0f - u - v;
    const Vec3 a = record.positions[t.x], b = record.positions[t.y], c = record.positions[t.z];
    point.position = a * w + b * u + c * v;
    Mat3 normalFromLocal(1.0f);
    if (record.placed)
    {
        point.position = transformPoint(record.placed->engineFromLocal, point.position);
        normalFromLocal = normalMatrix(record.placed->engineFromLocal.linear);
    }
    const auto toEngine = [&](Vec3 n) // vertex normals keep equal weights, as in surfacesOf
    { return record.placed ? glm::normalize(normalFromLocal * n) : n; };
    const Vec3 normal =
        record.normals
            ? toEngine(record.normals[t.x]) * w + toEngine(record.normals[t.y]) * u +
                  toEngine(record.normals[t.z]) * v
            : toEngine(glm::cross((b - a) / glm::length(b - a), (c - a) / glm::length(c - a)));
    const float length = glm::length(normal);
    if (length > 0.0f && length < kInfinity) point.normal = normal / length;
}

/// Sets the texture coordinates of the sets that few materials read.
void setMoreUvs(const SurfaceRecord& record, unsigned int sets, uint32_t primitive, float u,
                float v, MaterialPoint& point)
{
    for (uint32_t set = kFirstMoreUvs; set < kUvSets; ++set)
        if (sets >> set & 1u)
            point.setUv(set,
                        interpolate(record, record.uvsOfSet(set), primitive, u, v, Vec2(0.0f)));
}

} // namespace

Vec2 interpolateUv(const SurfaceRecord& record, uint32_t primitive, float u, float v)
{
    return interpolate(record, record.uvs, primitive, u, v, Vec2(0.0f));
}

Vec4 interpolateColor(const SurfaceRecord& record, uint32_t primitive, float u, float v)
{
    return interpolate(record, record.colors, primitive, u, v, Vec4(1.0f));
}

MaterialPoint materialPointOf(const SurfaceRecord& record, const MaterialRecord& material,
                              uint32_t primitive, float u, float v, bool front, Vec3 direction)
{
    MaterialPoint point;
    point.front = front;
    point.uv = interpolateUv(record, primitive, u, v);
    point.uv1 = interpolate(record, record.uvs1, primitive, u, v, Vec2(0.0f));
    point.r = interpolate(record, record.rs, primitive, u, v, 0.0f);
    point.r1 = interpolate(record, record.rs1, primitive, u, v, 0.0f);
    point.vertexColor = interpolateColor(record, primitive, u, v);
    point.direction = direction;
    if (material.generated) setGenerated(record, primitive, u, v, point);
    if (material.uvSets) setMoreUvs(record, material.uvSets, primitive, u, v, point);
    return point;
}

float textureScale(const SurfaceRecord& record, const Vec2* uvs, uint32_t primitive)
{
    if (!uvs) return 0.0f;
    const UVec3 t = record.triangles[primitive];
    Vec3 b = record.positions[t.y] - record.positions[t.x],
         c = record.positions[t.z] - record.positions[t.x];
    if (record.placed)
    {
        b = record.placed->engineFromLocal.linear * b;
        c = record.placed->engineFromLocal.linear * c;
    }
    const Vec2 p = uvs[t.y] - uvs[t.x], q = uvs[t.z] - uvs[t.x];
    const float ratio = std::fabs(p.x * q.y - p.y * q.x) / glm::length(glm::cross(b, c));
    return ratio < kInfinity ? std::sqrt(ratio) : 0.0f;
}

void setTextureWidths(const SurfaceRecord& record, uint32_t primitive, float footprint,
                      MaterialPoint& point)
{
    point.footprint = footprint;
    point.uvWidth = footprint * textureScale(record, record.uvs, primitive);
    point.uv1Width = footprint * textureScale(record, record.uvs1, primitive);
    if (!record.moreUvs) return;
    for (uint32_t set = kFirstMoreUvs; set < kUvSets; ++set)
        point.moreWidths[set - kFirstMoreUvs] =
            footprint * textureScale(record, record.uvsOfSet(set), primitive);
}

} // namespace osgRayTrace::engine
