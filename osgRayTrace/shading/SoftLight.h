// SoftLight.h - point and directional lights with a size: spheres and suns. Layer: shading.
// SPDX-License-Identifier: MIT
//
// A point light of radius r becomes a sphere of radiance I / (pi r^2), with I = diffuse * pi of its
// classic meaning. So the sphere sends to any point that sees all of it above the horizon what the
// point light sent. A directional light becomes a disc of radiance diffuse / sin^2 a on the sky.
// Both are seen under a cone of half-angle a, sampled uniformly by solid angle:
//
//   E = diffuse pi fade / sin^2 a / pi * integral over the cone of cos dw
//     = diffuse pi fade * mean of (2 / (1 + cos a)) cos,     sin a = r / d
//
// In the limit of r = 0 there is one direction of weight 1. Soft lights are lights for lit surfaces
// alone, as in OpenGL: cameras, mirrors and paths by chance do not see them.
//
// Lights that fade in other ways than spheres do keep the fade from the centre: fade is by the
// distance to the centre, or by r if that distance is less. Inside the sphere the cone is half of
// all directions. A spot's profile is that of each direction, so its edge is soft. Light leaves
// from the disc through the centre that faces the ray: geometry inside the sphere casts shadows as
// far as it is before this disc.
#pragma once

#include "osgRayTrace/shading/LightTable.h"

namespace osgRayTrace::engine
{

/// Holds a delta light sample of a soft light, or of a hard one, which needs no u.
struct SoftLightSample
{
    Vec3 wi{0.0f}; ///< unit, towards the light
    float distance = kInfinity;
    float attenuation = 0.0f; ///< distance and spot terms; 0: no light
    float weight = 1.0f;      ///< weight of the direction: 2 / (1 + cos a)
};

/// Returns 1 - cosine of the angle of this sine, in [0,1], without cancellation.
inline float oneMinusCosine(float sine)
{
    const float sine2 = std::min(sine * sine, 1.0f);
    return sine2 / (1.0f + std::sqrt(1.0f - sine2));
}

/// Returns a sample of the light from p. u: uniform in [0,1)^2. light.eyeSpace must have been
/// resolved.
SoftLightSample sampleSoft(const Light& light, Vec3 p, Vec2 u);

/// Returns the point at which a photon begins that leaves a point light of this radius along a
/// direction: uniform on the disc through the sphere's centre, seen along the direction.
Vec3 softOrigin(const Light& light, Vec3 direction, Vec2 u);

/// Returns the way that the light of a sun travels; uniform in the sun's cone, in which each
/// direction has the same weight.
Vec3 softDirection(const Light& light, Vec2 u);

/// Returns the weight of a direction of a soft light over the one direction of a hard light: 2 / (1
/// + cos a).
float softWeight(float sine);

} // namespace osgRayTrace::engine
