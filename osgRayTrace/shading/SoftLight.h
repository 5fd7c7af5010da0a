// SoftLight.h - point and directional lights with a size: spheres and suns. Layer: shading.
// SPDX-License-Identifier: MIT
//
// A point light of radius r becomes a sphere of radiance I / (pi r^2), I = diffuse * pi of its
// classic meaning, so that what it sends to any point that sees all of it above the horizon is what
// the point light sent. A directional light becomes a disc of radiance diffuse / sin^2 a on the
// sky. Both are seen under a cone of half-angle a, sampled uniformly by solid angle:
//
//   E = diffuse pi fade / sin^2 a / pi * integral over the cone of cos dw
//     = diffuse pi fade * mean of (2 / (1 + cos a)) cos,     sin a = r / d
//
// and in the limit of r = 0 there is one direction of weight 1. They are lights for what is lit, as
// in OpenGL: cameras, mirrors and paths by chance do not see them.
//
// Where lights fade in other ways than spheres do, that is as it was from the centre: fade is by
// the distance to the centre, or r where that is less; inside the sphere the cone is half of all
// directions. A spot's profile is that of each direction, so its edge is soft. Light leaves from
// the disc through the centre that faces the ray: geometry inside the sphere casts shadows as far
// as it is before this disc.
#pragma once

#include "osgRayTrace/shading/LightTable.h"

namespace osgRayTrace::engine
{

/// A delta light sample of a soft light, and of a hard one, which needs no u.
struct SoftLightSample
{
    Vec3 wi{0.0f}; ///< unit, towards the light
    float distance = kInfinity;
    float attenuation = 0.0f; ///< distance and spot terms; 0: no light
    float weight = 1.0f;      ///< of the direction: 2 / (1 + cos a)
};

/// 1 - cosine of the angle of this sine, in [0,1]: without cancellation.
inline float oneMinusCosine(float sine)
{
    const float sine2 = std::min(sine * sine, 1.0f);
    return sine2 / (1.0f + std::sqrt(1.0f - sine2));
}

/// u uniform in [0,1)^2. light.eyeSpace must have been resolved.
SoftLightSample sampleSoft(const Light& light, Vec3 p, Vec2 u);

/// The disc through the centre of a sphere, seen along a direction: where a photon begins that
/// leaves a point light of this radius. Uniform.
Vec3 softOrigin(const Light& light, Vec3 direction, Vec2 u);

/// The way the light of a sun travels; uniform in its cone, in which it has the same weight for
/// each.
Vec3 softDirection(const Light& light, Vec2 u);

/// That weight, over the one direction of a hard light: 2 / (1 + cos a).
float softWeight(float sine);

} // namespace osgRayTrace::engine
