// FogMedium.h - what fills the scene: its own medium, or OpenGL's fog as one. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"

#include <optional>

namespace osgRayTrace::engine
{

/// Returns the medium that OpenGL's fog becomes: albedo the fog's colour, extinction the density of
/// exponential fog, and for other modes that of half the light at half the fog's distance: sqrt(ln
/// 2) density if the exponent is squared, 2 ln 2 / (start + end) if the fog is linear.
inline Medium mediumOf(const Fog& fog)
{
    constexpr float kLn2 = 0.69314718f, kRootLn2 = 0.83255461f;
    float sigmaT = 0.0f;
    switch (fog.mode)
    {
    case FogMode::None:
        break;
    case FogMode::Linear:
        sigmaT = fog.start + fog.end > 0.0f ? 2.0f * kLn2 / (fog.start + fog.end) : 0.0f;
        break;
    case FogMode::Exponential:
        sigmaT = fog.density;
        break;
    case FogMode::ExponentialSquared:
        sigmaT = kRootLn2 * fog.density;
        break;
    }
    Medium medium;
    const Vec3 albedo = glm::clamp(fog.color, 0.0f, 1.0f);
    medium.sigmaS = sigmaT * albedo;
    medium.sigmaA = sigmaT * (Vec3(1.0f) - albedo);
    return medium;
}

/// Returns what fills the scene around its bodies: its atmosphere, or else with FogUse::Medium the
/// medium that the fog of the first material with fog becomes.
inline std::optional<Atmosphere> atmosphereOf(const Scene& scene)
{
    if (scene.atmosphere) return *scene.atmosphere;
    if (scene.fogUse != FogUse::Medium) return std::nullopt;
    for (const Material& material : scene.materials)
        if (material.fog.mode != FogMode::None) return Atmosphere{mediumOf(material.fog)};
    return std::nullopt;
}

} // namespace osgRayTrace::engine
