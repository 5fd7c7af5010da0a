// FixedFunctionLighting.h - OpenGL's lighting equations at a hit. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/HitShading.h"

namespace osgRayTrace::engine
{

/// A point on a fixed-function surface and the light that it has gathered.
struct FixedFunctionPoint
{
    FaceColors colors;
    Vec3 normal;   ///< unit, as OpenGL uses it: turned to the viewer for two-sided lighting only
    Vec3 halfAxis; ///< direction to the viewer in the half vector
    bool separateSpecular = false;
    TextureTerms textures;
    Vec3 light{0.0f};      ///< sum of the terms of all lights so far
    Vec3 highlights{0.0f}; ///< apart from them if they are not to be textured
};

FixedFunctionPoint fixedFunctionPoint(const PassContext& context, const RayHitBlock& rays,
                                      const SurfaceLanes& surface, int i,
                                      const MaterialPoint& point);

/// Adds the terms of one light [OpenGL21, eq. 2.1]: attenuation * (ambient + diffuse + specular);
/// the last two times visibility: 0 if the light is hidden, 1 or the weight of the sample else.
/// Highlights are computed with the viewer at infinity, as OpenGL does unless told otherwise (then
/// where the ray comes from), and at each point instead of each vertex.
void addLight(FixedFunctionPoint& point, const Light& light, Vec3 wi, float attenuation,
              float visibility);

/// Emission, ambient and lights together, textured. Display-referred colours are clamped to 1
/// before the texture, as OpenGL does; highlights that are separate come after it.
Vec3 litColor(const PassContext& context, const FixedFunctionPoint& point);

} // namespace osgRayTrace::engine
