// FixedFunctionLighting.h - OpenGL's lighting equations at a hit. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/HitShading.h"

namespace osgRayTrace::engine
{

/// A point on a fixed-function surface, and the light that the point has gathered.
struct FixedFunctionPoint
{
    FaceColors colors;
    Vec3 normal;   ///< unit normal as in OpenGL: turned to the viewer for two-sided lighting only
    Vec3 halfAxis; ///< direction to the viewer in the half vector
    bool separateSpecular = false;
    TextureTerms textures;
    Vec3 light{0.0f};      ///< sum of the terms of the lights so far
    Vec3 highlights{0.0f}; ///< highlights that are not textured, apart from light
};

FixedFunctionPoint fixedFunctionPoint(const PassContext& context, const RayHitBlock& rays,
                                      const SurfaceLanes& surface, int i,
                                      const MaterialPoint& point);

/// Adds the terms of one light [OpenGL21, eq. 2.1]: attenuation * (ambient + visibility * (diffuse
/// + specular)). visibility is 0 if the light is hidden, else 1 or the weight of the sample.
/// Highlights are computed with the viewer at infinity, as OpenGL does by default; for a material
/// with localViewer the viewer is at the start of the ray. Highlights are computed at each point
/// instead of each vertex.
void addLight(FixedFunctionPoint& point, const Light& light, Vec3 wi, float attenuation,
              float visibility);

/// Returns emission, ambient and lights together, textured. Display-referred colours are clamped to
/// 1 before the texture, as OpenGL does. Separate highlights are added after the texture.
Vec3 litColor(const PassContext& context, const FixedFunctionPoint& point);

} // namespace osgRayTrace::engine
