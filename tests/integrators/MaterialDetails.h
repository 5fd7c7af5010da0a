// MaterialDetails.h - quads with normal maps and other details, lit from one side. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/integrators/Measure.h"

namespace osgRayTrace::engine::test
{

constexpr IntegratorKind kKinds[] = {IntegratorKind::Path, IntegratorKind::Whitted};

inline Material withDetail(Material material, const MaterialDetail& detail)
{
    material.detail = std::make_shared<MaterialDetail>(detail);
    return material;
}

/// Returns a texture of one texel.
inline std::shared_ptr<const Texture> texel(Vec4 value)
{
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 1;
    texture->floats = {value.x, value.y, value.z, value.w};
    return texture;
}

/// Returns the texel of a normal that is turned by an angle from the surface's towards s.
inline std::shared_ptr<const Texture> tiltedTexel(double degrees)
{
    const auto angle = static_cast<float>(degrees * M_PI / 180.0);
    return texel(Vec4(0.5f + 0.5f * std::sin(angle), 0.5f, 0.5f + 0.5f * std::cos(angle), 1.0f));
}

/// Returns a diffuse quad in the plane z = 0 with the normal map of texture 0.
inline std::shared_ptr<Mesh> mappedQuad(Vec2 alongX, Vec2 alongY)
{
    const auto mesh = quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    std::vector<Vec2> uvs;
    for (const Vec3& p : mesh->positions)
        uvs.push_back(alongX * (0.5f * p.x + 0.5f) + alongY * (0.5f * p.y + 0.5f));
    mesh->uvs = std::move(uvs);
    return mesh;
}

inline Material mappedMaterial(Material material, float scale = 1.0f)
{
    MaterialDetail detail;
    detail.textures[kNormalRole] = 0;
    detail.normalScale = scale;
    return withDetail(material, detail);
}

/// Returns a light that shines downwards and along x: it comes from (-1, 0, 1) or (1, 0, 1).
inline Light slanted(float x)
{
    Light light;
    light.kind = LightKind::Directional;
    light.direction = glm::normalize(Vec3(-x, 0.0f, -1.0f));
    light.diffuse = Vec3(1.0f);
    return light;
}

inline View fromAbove()
{
    return patchView({0, 0, 0}, {0, 0, 1}, 0.1, 8);
}

inline double cosineOf(double degrees)
{
    return std::cos(degrees * M_PI / 180.0);
}

} // namespace osgRayTrace::engine::test
