// BeamScenes.h - scenes whose light in media comes by photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/integrators/MediaScenes.h"

namespace osgRayTrace::engine::test
{

/// Returns a point light in fog beside a flat mirror. Along the ray from the origin along +x the
/// radiance is that of the light, 1 away from the ray, and of its image, 3 away: both by quadrature
/// [Sun05]. Next to nothing is scattered twice.
constexpr float kMirrorAlbedo = 1e-3f;
constexpr double kOfLight = 0.011375223 * double(kMirrorAlbedo);
constexpr double kOfImage = 0.002346865 * double(kMirrorAlbedo);
inline SceneBuilder mirrorInFog()
{
    SceneBuilder builder;
    setAtmosphere(builder, mediumOf(0.1f, kMirrorAlbedo), 400.0f);
    builder.add(quadMesh({-300, -300, -1}, {600, 0, 0}, {0, 600, 0}), mirror(Vec3(1.0f)));
    builder.add(quadMesh({10, -0.01f, -0.01f}, {0, 0.02f, 0}, {0, 0, 0.02f}), lambert(Vec3(0.0f)));
    builder.addLight(pointLight({5, 0, 1}, Vec3(float(1.0 / 3.14159265358979))));
    return builder;
}

/// Returns the view of one ray from the origin along +x.
inline View alongMirror()
{
    return perspectiveView({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 1e-3, 4, 4);
}

/// Returns the Cornell box in fog, of which half of the light crosses the box.
inline SceneBuilder foggyBox(float anisotropy = 0.0f, Vec3 albedo = Vec3(0.9f))
{
    SceneBuilder builder = cornellBox();
    Medium medium;
    medium.sigmaS = albedo / 600.0f;
    medium.sigmaA = (Vec3(1.0f) - albedo) / 600.0f;
    medium.anisotropy = anisotropy;
    setAtmosphere(builder, medium, 700.0f, Vec3(278, 273, 280));
    return builder;
}

} // namespace osgRayTrace::engine::test
