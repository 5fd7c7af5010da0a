// Environments.h - images of the sphere, for the tests of environments.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Light.h"
#include "osgRayTrace/shading/EnvironmentMap.h"

#include <cmath>
#include <functional>
#include <memory>

namespace osgRayTrace::engine::test
{

inline std::shared_ptr<EnvironmentImage> newEnvironment(int width, int height, Vec3 radiance)
{
    auto image = std::make_shared<EnvironmentImage>();
    image->width = width;
    image->height = height;
    image->radiance.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                           radiance);
    return image;
}

inline Vec3& pixelOf(EnvironmentImage& image, int x, int y)
{
    return image.radiance[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                          static_cast<std::size_t>(x)];
}

/// Returns an image whose pixels have the radiance that the function gives for the direction of
/// each pixel's middle.
inline std::shared_ptr<EnvironmentImage> newEnvironment(int width, int height,
                                                        const std::function<Vec3(Vec3d)>& radiance)
{
    const auto image = newEnvironment(width, height, Vec3(0.0f));
    const EnvironmentMap map(image);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            pixelOf(*image, x, y) = radiance(map.direction(x + 0.5, y + 0.5));
    return image;
}

/// Returns a sky that is brighter towards the horizon, over darker ground; one of its pixels has as
/// much energy as all others together.
inline std::shared_ptr<EnvironmentImage> sunnySky(int width, int height)
{
    const auto image =
        newEnvironment(width, height,
                       [](Vec3d d)
                       {
                           if (d.z < 0.0) return Vec3(0.12f, 0.1f, 0.08f);
                           const float haze = static_cast<float>((1.0 - d.z) * (1.0 - d.z));
                           return Vec3(0.3f, 0.5f, 0.9f) + Vec3(0.6f, 0.5f, 0.3f) * haze;
                       });
    const int x = width * 5 / 8, y = height * 3 / 4;
    const EnvironmentMap sky(image);
    const double energy = sky.luminanceIntegral() / sky.solidAngle(y);
    const Vec3 colour(1.0f, 0.9f, 0.7f);
    pixelOf(*image, x, y) = colour * static_cast<float>(energy / luminance(colour));
    return image;
}

inline Light environmentLight(std::shared_ptr<const EnvironmentImage> image,
                              const Mat3& mapFromEngine = Mat3(1.0f))
{
    Light light;
    light.kind = LightKind::Environment;
    light.radiance = Vec3(1.0f);
    light.environment.image = std::move(image);
    light.environment.mapFromEngine = mapFromEngine;
    return light;
}

/// Returns the rotation that turns the zenith of the map by an angle towards +x.
inline Mat3 tilted(float angleRadians)
{
    const float s = std::sin(angleRadians), c = std::cos(angleRadians);
    // The columns are the axes of engine space in the coordinates of the map.
    return Mat3(Vec3(c, 0, s), Vec3(0, 1, 0), Vec3(-s, 0, c));
}

} // namespace osgRayTrace::engine::test
