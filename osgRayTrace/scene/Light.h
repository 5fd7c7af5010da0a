// Light.h - the description of every light that the engine knows. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/scene/Environment.h"
#include "osgRayTrace/scene/Mesh.h"

#include <cstdint>
#include <string>

namespace osgRayTrace::engine
{

enum class LightKind : uint8_t
{
    Directional,   ///< osg::Light with w = 0
    Point,         ///< osg::Light with w != 0, with attenuation and spot terms
    Parallelogram, ///< AreaLight: corner and two edges, constant radiance
    Mesh,          ///< an instance whose material emits
    Environment,   ///< EnvironmentLight: light from all around; the first of a scene counts
};

struct Light
{
    std::string name;
    LightKind kind = LightKind::Point;
    uint32_t number = 0; ///< number of the osg::Light, or kNoLightNumber: see isLightEnabled

    /// True for a headlight: position and direction are in view space (x right, y up, looking along
    /// -z) and in world lengths. RenderSession places the headlight for each view.
    bool eyeSpace = false;

    /// Directional, Point: false if nothing hides this light. The light then reaches every surface
    /// that faces it, in all integrators, and its photons go on through surfaces on their first
    /// flight: see PhotonTracer.
    bool castsShadows = true;

    // Directional, Point: these are the fixed-function light colours. Diffuse 1 without attenuation
    // gives a Lambert surface its own colour at normal incidence, that is an irradiance of pi.
    Vec3 ambient{0.0f};
    Vec3 diffuse{0.0f};
    Vec3 specular{0.0f};
    Vec3 position{0.0f}; ///< Point, engine space
    Vec3 direction{0.0f, 0.0f,
                   -1.0f}; ///< unit; Directional: the way the light travels; Point: the spot's axis
    float attenuationConstant = 1.0f;
    float attenuationLinear = 0.0f;    ///< [1/length], engine units, in eye space as well
    float attenuationQuadratic = 0.0f; ///< [1/length^2], engine units
    float range =
        0.0f; ///< Point: distance at which it ends [engine units], eye space as well; 0: none
    float spotExponent = 0.0f;
    float spotCosCutoff = -1.0f; ///< cosine of the cut-off angle; -1: no spot

    // Lights with a radius or a sine cast soft shadows and stay invisible: see SoftLight.h.
    float radius =
        0.0f;          ///< Point: radius of the sphere [length], engine units, in eye space as well
    float sine = 0.0f; ///< Directional: sine of the half-angle of the disc on the sky, [0,1]

    // Parallelogram: the image of (u, v) in [0,1]^2 is corner + u*edgeU + v*edgeV, and the front
    // side faces cross(edgeU, edgeV). Mesh: radiance is the material's emission, and the front is
    // that of the mesh's triangles.
    Vec3 corner{0.0f};
    Vec3 edgeU{1.0f, 0.0f, 0.0f};
    Vec3 edgeV{0.0f, 1.0f, 0.0f};
    Vec3 radiance{0.0f}; ///< [W/(m^2 sr)]
    bool twoSided = false;
    uint32_t instance = kInvalid; ///< the geometry that rays hit: Parallelogram and Mesh

    Environment environment; ///< Environment: its image, which radiance multiplies

    Stamp changed = 0;
};

/// Returns the factor by which the light of a point light fades out towards its range, as glTF
/// recommends it [glTF20, KHR_lights_punctual].
inline float rangeTerm(const Light& light, float distance)
{
    if (!(light.range > 0.0f)) return 1.0f;
    const float ratio = distance / light.range, ratio2 = ratio * ratio;
    return ratio2 < 1.0f ? 1.0f - ratio2 * ratio2 : 0.0f;
}

inline bool isSoft(const Light& light)
{
    return (light.kind == LightKind::Point && light.radius > 0.0f) ||
           (light.kind == LightKind::Directional && light.sine > 0.0f);
}

} // namespace osgRayTrace::engine
