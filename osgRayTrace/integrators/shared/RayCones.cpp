// RayCones.cpp - the cones of sixteen rays as vector code. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/RayCones.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Footprints grow no more below this cosine, where the pixel sees the edge of a surface.
constexpr float kLeastCosine = 0.05f;

/// Holds how pixels grow along rays: with distance from the eye, or not at all in parallel views.
struct PixelGrowth
{
    PlainVec3 axis{0.0f, 0.0f, 0.0f};  ///< unit normal of the pixels
    float width = 0.0f, spread = 0.0f; ///< of a ray along the axis
};

PixelGrowth growthOf(const CameraRays& camera, float scale)
{
    const Vec3 area = camera.orthographic ? glm::cross(camera.originDx, camera.originDy)
                                          : glm::cross(camera.directionDx, camera.directionDy);
    const float size = glm::length(area);
    if (!(size > 0.0f)) return {};
    const Vec3 axis = area / size;
    const float width = scale * std::sqrt(size);
    if (camera.orthographic) return {plainOf(axis), width, 0.0f};
    return {plainOf(axis), 0.0f, width / std::fabs(glm::dot(axis, camera.direction))};
}

/// A pixel is seen under the solid angle spread^2 cos^3 at the angle to the axis: the plane of
/// pixels is 1/cos as far and tilted by cos.
OSGRAYTRACE_KERNEL
void growAlong(const PixelGrowth& pixel, const RayBlock& rays, ConeLanes& cones)
{
    const PixelGrowth p = pixel;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float cosine = std::fabs(dot(p.axis, plainDirection(rays, i)));
        const float root = std::sqrt(cosine);
        cones.width[i] = p.width * root;
        cones.spread[i] = p.spread * cosine * root;
    }
}

OSGRAYTRACE_KERNEL
void footprints(const RayBlock& rays, const ConeLanes& cones, SurfaceLanes& surface)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float cosine =
            std::fabs(dot(plainOf(surface.geometricNormal, i), plainDirection(rays, i)));
        const float bounded = select(cosine > kLeastCosine, cosine, kLeastCosine);
        const float width = cones.width[i] + cones.spread[i] * rays.tFar[i];
        surface.footprint[i] = width / std::sqrt(bounded);
    }
}

OSGRAYTRACE_KERNEL
void move(const RayBlock& rays, LaneMask mirrored, ConeLanes& cones)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const uint32_t keeps = laneBit(mirrored, i);
        cones.width[i] = select(keeps, cones.width[i] + cones.spread[i] * rays.tFar[i], 0.0f);
        cones.spread[i] = select(keeps, cones.spread[i], 0.0f);
    }
}

} // namespace

void cameraCones(const PassContext& context, const RayBlock& rays, ConeLanes& cones)
{
    growAlong(growthOf(context.camera, context.coneScale), rays, cones);
}

void setFootprints(const RayBlock& rays, const ConeLanes& cones, SurfaceLanes& surface)
{
    footprints(rays, cones, surface);
    surface.coned = surface.hits;
}

void moveCones(const RayBlock& rays, LaneMask mirrored, ConeLanes& cones)
{
    move(rays, mirrored, cones);
}

} // namespace osgRayTrace::engine
