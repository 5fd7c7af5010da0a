// FixedFunctionLighting.cpp - OpenGL's lighting equations at a hit. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/whitted/FixedFunctionLighting.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

FixedFunctionPoint fixedFunctionPoint(const PassContext& context, const RayHitBlock& rays,
                                      const SurfaceLanes& surface, int i,
                                      const MaterialPoint& point)
{
    const MaterialTable& materials = context.traced->materials();
    const Material& material = *materials[surface.material[i]].material;
    FixedFunctionPoint p;
    const bool front = isFrontFace(material, point.front);
    p.colors = fixedFunctionColors(material, point.vertexColor, front);
    p.normal = laneOf(surface.shadingNormal, i);
    if (material.twoSidedLighting && !front) p.normal = -p.normal;
    p.halfAxis = context.towardsViewer;
    if (material.localViewer) p.halfAxis = -directionOf(rays.ray, i);
    p.separateSpecular = material.separateSpecular;
    p.textures = materials.textures(material, point);
    return p;
}

void addLight(FixedFunctionPoint& p, const Light& light, Vec3 wi, float attenuation,
              float visibility)
{
    Vec3 sum = light.ambient * p.colors.ambient;
    const float cosine = glm::dot(p.normal, wi);
    if (visibility > 0.0f && cosine > 0.0f)
    {
        sum += light.diffuse * p.colors.diffuse * (cosine * visibility);
        const Vec3 specular = light.specular * p.colors.specular;
        const Vec3 half = wi + p.halfAxis;
        const float length2 = glm::dot(half, half);
        const float cosH = length2 > 0.0f ? glm::dot(p.normal, half) / std::sqrt(length2) : 0.0f;
        if (specular != Vec3(0.0f) && (cosH > 0.0f || p.colors.shininess == 0.0f))
            (p.separateSpecular ? p.highlights : sum) +=
                specular * (std::pow(std::max(cosH, 0.0f), p.colors.shininess) * visibility *
                            (p.separateSpecular ? attenuation : 1.0f));
    }
    p.light += sum * attenuation;
}

Vec3 litColor(const PassContext& context, const FixedFunctionPoint& p)
{
    const Scene& scene = context.traced->scene();
    Vec3 color = p.colors.emission + scene.ambient * p.colors.ambient + p.light;
    if (scene.displayReferred) color = glm::clamp(color, 0.0f, 1.0f);
    return Vec3(applyTextures(p.textures, Vec4(color, p.colors.alpha))) + p.highlights;
}

} // namespace osgRayTrace::engine
