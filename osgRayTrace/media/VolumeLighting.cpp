// VolumeLighting.cpp - Lambert's law on the gradient of a volume. Layer: media.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/VolumeLighting.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// The ambient and the diffuse part of the shaders' light, whatever the light's own colour is.
constexpr float kAmbient = 0.1f, kDiffuse = 0.9f;

} // namespace

Vec3 litDirection(const GridRecord& grid, const VolumeLight& light, Vec3 exit)
{
    // In the space of the tile's cube, as gl_ModelViewMatrixInverse leads to.
    const Vec3 towards = light.isFar ? grid.tileFromEngine.linear * light.direction
                                     : transformPoint(grid.tileFromEngine, light.position) -
                                           transformPoint(grid.tileFromEngine, exit);
    const float length = glm::length(towards);
    return length > 0.0f ? towards / length : Vec3(0.0f);
}

float lightScale(const VolumeImage& image, Vec3 p, float step, Vec3 litDirection)
{
    Vec3 gradient;
    for (int k = 0; k < 3; ++k)
    {
        Vec3 d(0.0f);
        d[k] = step;
        gradient[k] = volumeValue(image, p + d) - volumeValue(image, p - d);
    }
    // A vector of tiny values would have no length in floats.
    const float largest =
        std::max(std::fabs(gradient.x), std::max(std::fabs(gradient.y), std::fabs(gradient.z)));
    if (!(largest > 0.0f) || !(largest < kInfinity)) return 1.0f;
    const float cosine = glm::dot(glm::normalize(gradient / largest), litDirection);
    return kAmbient + kDiffuse * std::max(0.0f, cosine);
}

} // namespace osgRayTrace::engine
