// Medium.h - what absorbs, scatters and emits light between surfaces. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <cmath>

namespace osgRayTrace::engine
{

/// Holds a homogeneous participating medium. Its lengths are scene units, not engine units, so that
/// a Medium does not depend on Scene::unit.
struct Medium
{
    Vec3 sigmaA{0.0f};       ///< absorption coefficient [1/length]
    Vec3 sigmaS{0.0f};       ///< scattering coefficient [1/length]
    Vec3 emission{0.0f};     ///< emitted radiance per length [W/(m^2 sr length)]
    float anisotropy = 0.0f; ///< mean cosine g of the phase function [Henyey41]
    /// Diameter [micrometres] of the water droplets whose phase function counts; 0: none.
    float dropletSize = 0.0f;
    int priority = 0; ///< the body of the highest priority is what fills overlapping bodies

    bool absorbs() const { return sigmaA != Vec3(0.0f); }
    bool scatters() const { return sigmaS != Vec3(0.0f); }
    bool emits() const { return emission != Vec3(0.0f); }
    bool isClear() const { return !absorbs() && !scatters() && !emits(); }

    bool operator==(const Medium& other) const
    {
        return sigmaA == other.sigmaA && sigmaS == other.sigmaS && emission == other.emission &&
               anisotropy == other.anisotropy && dropletSize == other.dropletSize &&
               priority == other.priority;
    }
};

/// Holds the medium that fills the whole scene within a sphere, except for its bodies. Light of the
/// sun and the sky enters the medium at the sphere.
struct Atmosphere
{
    Medium medium;
    Vec3 centre{0.0f};   ///< of the sphere, and on the base of heights [engine space]
    float radius = 0.0f; ///< [engine units]; 0: the sphere around all that is traced
    /// The height over centre in which the medium thins out to 1/e [engine units]; below centre it
    /// is even. 0: it is even everywhere.
    float scaleHeight = 0.0f;
    Vec3 up{0.0f, 0.0f, 1.0f}; ///< unit; in which heights grow

    bool operator==(const Atmosphere& other) const
    {
        return medium == other.medium && centre == other.centre && radius == other.radius &&
               scaleHeight == other.scaleHeight && up == other.up;
    }
};

/// Returns the albedo with which a thick body has a colour in white light: s = 4.20863 c -
/// sqrt(9.59217 + 41.6808 c + 17.7126 c^2) + 4.09712, albedo = (1 - s^2) / (1 - g s^2) [dEon16, eq.
/// 53.7]. color, result: [0,1].
inline double albedoOfColor(double color, double g)
{
    const double root = std::sqrt(9.59217 + 41.6808 * color + 17.7126 * color * color);
    const double s = 4.20863 * color - root + 4.09712;
    const double albedo = (1.0 - s * s) / (1.0 - g * s * s);
    return albedo < 0.0 ? 0.0 : albedo > 1.0 ? 1.0 : albedo;
}

/// Returns the absorption coefficient [1/length] of a body that leaves this share of white light
/// after a distance [glTF20, KHR_materials_volume]. A share of 0 counts as 1e-6; a distance of 0
/// absorbs nothing.
inline Vec3 absorptionOf(Vec3 color, float distance)
{
    if (!(distance > 0.0f)) return Vec3(0.0f);
    const Vec3 usable = glm::clamp(color, 1e-6f, 1.0f);
    return glm::max(-glm::log(usable), 0.0f) *
           static_cast<float>(std::min(1.0 / double(distance), 1e30));
}

} // namespace osgRayTrace::engine
