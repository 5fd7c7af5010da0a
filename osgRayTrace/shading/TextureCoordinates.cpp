// TextureCoordinates.cpp - texture generation and texture matrices. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/TextureCoordinates.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the coordinates of a sphere map [OpenGL21, sect. 2.11.4]: r is the direction that the
/// sphere in the picture reflects at (s, t).
Vec4 sphereMap(Vec3 r)
{
    const float m = 2.0f * std::sqrt(r.x * r.x + r.y * r.y + (r.z + 1.0f) * (r.z + 1.0f));
    if (!(m > 0.0f))
        return Vec4(0.5f, 0.5f, 0.0f, 1.0f); // straight away from the eye: all of the rim
    return Vec4(r.x / m + 0.5f, r.y / m + 0.5f, 0.0f, 1.0f);
}

Vec4 source(TextureCoordinates coordinates, const TexturePoint& p)
{
    switch (coordinates)
    {
    case TextureCoordinates::Uv0:
        return Vec4(p.uv, p.r, 1.0f);
    case TextureCoordinates::Uv1:
        return Vec4(p.uv1, p.r1, 1.0f);
    case TextureCoordinates::Position:
        return Vec4(p.position, 1.0f);
    case TextureCoordinates::SphereMap:
        return sphereMap(p.eyeFromEngine * glm::reflect(p.direction, p.normal));
    case TextureCoordinates::ReflectionMap:
        return Vec4(p.eyeFromEngine * glm::reflect(p.direction, p.normal), 1.0f);
    case TextureCoordinates::NormalMap:
        return Vec4(p.eyeFromEngine * p.normal, 1.0f);
    }
    return Vec4(0.0f, 0.0f, 0.0f, 1.0f);
}

/// Returns by how much the (s, t) of a matrix grow areas: of (u, v), or of a surface in space with
/// this normal.
float areaScale(const Mat4& m, bool inSpace, Vec3 normal)
{
    if (!inSpace) return std::fabs(m[0][0] * m[1][1] - m[1][0] * m[0][1]);
    const Vec3 s(m[0][0], m[1][0], m[2][0]), t(m[0][1], m[1][1], m[2][1]);
    return std::fabs(glm::dot(glm::cross(s, t), normal));
}

} // namespace

Vec4 textureCoordinates(const TextureMapping& mapping, const TexturePoint& point)
{
    const Vec4 coordinates = source(mapping.coordinates, point);
    if (!mapping.transformed) return coordinates;
    const Vec4 mapped = mapping.matrix * coordinates;
    return mapping.partly ? mapped + mapping.ownMatrix * source(mapping.own, point) : mapped;
}

float textureWidth(const TextureMapping& mapping, const TexturePoint& point)
{
    if (mapping.partly || dependsOnEye(mapping)) return 0.0f;
    const bool inSpace = mapping.coordinates == TextureCoordinates::Position;
    const float width = inSpace                                          ? point.footprint
                        : mapping.coordinates == TextureCoordinates::Uv0 ? point.uvWidth
                                                                         : point.uv1Width;
    if (!mapping.transformed) return inSpace ? 0.0f : width;
    const Mat4& m = mapping.matrix;
    const bool affine = m[0][3] == 0.0f && m[1][3] == 0.0f && m[2][3] == 0.0f && m[3][3] != 0.0f;
    if (!affine || !(width > 0.0f)) return 0.0f;
    return width * std::sqrt(areaScale(m, inSpace, point.normal)) / std::fabs(m[3][3]);
}

} // namespace osgRayTrace::engine
