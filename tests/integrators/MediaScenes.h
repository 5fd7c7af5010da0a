// MediaScenes.h - bodies and air of participating media, for the tests of integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/Environments.h"
#include "tests/integrators/Measure.h"

namespace osgRayTrace::engine::test
{

/// Returns a grey medium of an extinction and an albedo.
inline Medium mediumOf(float sigmaT, float albedo, float g = 0.0f)
{
    Medium medium;
    medium.sigmaS = Vec3(sigmaT * albedo);
    medium.sigmaA = Vec3(sigmaT * (1.0f - albedo));
    medium.anisotropy = g;
    return medium;
}

/// Returns the smooth boundary of a medium; of ior 1 it bends no light.
inline Material bodyOf(const Medium& medium, float ior = 1.0f)
{
    Material material = glass(ior);
    MaterialDetail detail;
    detail.interior = medium;
    material.detail = std::make_shared<MaterialDetail>(detail);
    return material;
}

inline void setAtmosphere(SceneBuilder& builder, const Medium& medium, float radius,
                          Vec3 centre = Vec3(0.0f))
{
    Atmosphere atmosphere;
    atmosphere.medium = medium;
    atmosphere.radius = radius;
    atmosphere.centre = centre;
    builder.scene->atmosphere = std::make_shared<Atmosphere>(atmosphere);
}

/// Has the medium around bodies thin out above its centre.
inline void thinOut(SceneBuilder& builder, float scaleHeight, Vec3 up = Vec3(0, 0, 1))
{
    Atmosphere atmosphere = *builder.scene->atmosphere;
    atmosphere.scaleHeight = scaleHeight;
    atmosphere.up = up;
    builder.scene->atmosphere = std::make_shared<Atmosphere>(atmosphere);
}

/// Adds a sky that is white, or so bright.
inline void addSky(SceneBuilder& builder, float radiance = 1.0f)
{
    Light sky;
    sky.kind = LightKind::Environment;
    sky.radiance = Vec3(radiance);
    sky.environment.image = newEnvironment(4, 2, Vec3(1.0f));
    builder.addLight(sky);
}

/// Adds a sky that is white on one half of all directions.
inline void addHalfSky(SceneBuilder& builder, bool above)
{
    Light sky;
    sky.kind = LightKind::Environment;
    sky.radiance = Vec3(1.0f);
    sky.environment.image = newEnvironment(
        16, 8, [above](Vec3d d) { return Vec3((d.z > 0.0) == above ? 1.0f : 0.0f); });
    builder.addLight(sky);
}

/// Returns a narrow view along the x axis, forwards or back.
inline View alongX(double from, double towards = 1.0)
{
    return perspectiveView({from, 0.1, 0.2}, {from + towards, 0.1, 0.2}, {0, 0, 1}, 1e-3, 4, 4);
}

/// Returns a view of one direction: a patch of the given side seen along -normal.
inline View alongRay(Vec3d centre, Vec3d normal, int pixels = 4)
{
    return patchView(centre, normal, 1e-4, pixels);
}

} // namespace osgRayTrace::engine::test
