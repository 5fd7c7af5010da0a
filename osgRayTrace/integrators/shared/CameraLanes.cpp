// CameraLanes.cpp - camera rays and window depths of a block of pixels. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/CameraLanes.h"

#include <cmath>
#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

OSGRAYTRACE_KERNEL
void pixelPoints(const PassKey& key, int left, int bottom, bool centres, FloatLanes& x,
                 FloatLanes& y, UintLanes& seeds)
{
    const PassKey k = key;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const int px = left + (i & 3), py = bottom + (i >> 2);
        const uint32_t seed = pixelSeed(k, static_cast<uint32_t>(px), static_cast<uint32_t>(py));
        float jx, jy;
        sobol2Ordered(k.index, dimensionSeed(seed, DimensionPixel), jx, jy);
        seeds[i] = seed;
        x[i] = static_cast<float>(px) + select(centres, 0.5f, jx);
        y[i] = static_cast<float>(py) + select(centres, 0.5f, jy);
    }
}

OSGRAYTRACE_KERNEL
void pixelCentres(int left, int bottom, FloatLanes& x, FloatLanes& y)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        x[i] = static_cast<float>(left + (i & 3)) + 0.5f;
        y[i] = static_cast<float>(bottom + (i >> 2)) + 0.5f;
    }
}

OSGRAYTRACE_KERNEL
void raysThrough(const CameraRays& camera, const FloatLanes& x, const FloatLanes& y, RayBlock& ray)
{
    const CameraRays c = camera;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float dx = c.direction.x + x[i] * c.directionDx.x + y[i] * c.directionDy.x;
        const float dy = c.direction.y + x[i] * c.directionDx.y + y[i] * c.directionDy.y;
        const float dz = c.direction.z + x[i] * c.directionDx.z + y[i] * c.directionDy.z;
        const float length = std::sqrt(dx * dx + dy * dy + dz * dz);
        const float inverse = 1.0f / length;
        ray.directionX[i] = dx * inverse;
        ray.directionY[i] = dy * inverse;
        ray.directionZ[i] = dz * inverse;
        ray.originX[i] = c.origin.x + x[i] * c.originDx.x + y[i] * c.originDy.x;
        ray.originY[i] = c.origin.y + x[i] * c.originDx.y + y[i] * c.originDy.y;
        ray.originZ[i] = c.origin.z + x[i] * c.originDx.z + y[i] * c.originDy.z;
        ray.tNear[i] = c.nearS * length;
        ray.tFar[i] = kInfinity;
        ray.time[i] = 0.0f;
        ray.mask[i] = 0xffffffffu;
        ray.id[i] = 0;
        ray.flags[i] = 0;
    }
}

OSGRAYTRACE_KERNEL
void planeDistances(const CameraRays& camera, int left, int bottom, const SurfaceLanes& surface,
                    FloatLanes& along)
{
    const CameraRays c = camera;
    const LaneMask hits = surface.hits;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float x = static_cast<float>(left + (i & 3)) + 0.5f;
        const float y = static_cast<float>(bottom + (i >> 2)) + 0.5f;
        const float dx = c.direction.x + x * c.directionDx.x + y * c.directionDy.x;
        const float dy = c.direction.y + x * c.directionDx.y + y * c.directionDy.y;
        const float dz = c.direction.z + x * c.directionDx.z + y * c.directionDy.z;
        const float ox = c.origin.x + x * c.originDx.x + y * c.originDy.x;
        const float oy = c.origin.y + x * c.originDx.y + y * c.originDy.y;
        const float oz = c.origin.z + x * c.originDx.z + y * c.originDy.z;
        const float nx = surface.geometricNormal.x[i], ny = surface.geometricNormal.y[i],
                    nz = surface.geometricNormal.z[i];
        const float hx = surface.position.x[i], hy = surface.position.y[i],
                    hz = surface.position.z[i];
        const float s =
            (nx * (hx - ox) + ny * (hy - oy) + nz * (hz - oz)) / (nx * dx + ny * dy + nz * dz);
        // Where the plane is seen edge-on the centre may miss it by far: then the sample's own
        // depth.
        const float d2 = dx * dx + dy * dy + dz * dz;
        const float sHit = ((hx - ox) * dx + (hy - oy) * dy + (hz - oz) * dz) / d2;
        const bool usable = (s > 0.5f * sHit) & (s < 2.0f * sHit);
        along[i] = select(laneBit(hits, i), select(usable, s, sHit), kInfinity);
    }
}

OSGRAYTRACE_KERNEL
void windowDepths(const CameraRays& camera, int left, int bottom, LaneMask hits,
                  const FloatLanes& along, float* __restrict depth)
{
    const CameraRays c = camera;
    const uint32_t parallel = maskOf(c.orthographic);
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float x = static_cast<float>(left + (i & 3)) + 0.5f;
        const float y = static_cast<float>(bottom + (i >> 2)) + 0.5f;
        const float beyond = 1.0f / along[i] - 1.0f - x * c.depthDx - y * c.depthDy;
        const float window = c.nearDepth + c.depthSlope * select(parallel, along[i], beyond);
        const float low = select(window > 0.0f, window, 0.0f);
        const float clamped = select(low < 1.0f, low, 1.0f);
        depth[i] = select(laneBit(hits, i), clamped, 1.0f);
    }
}

} // namespace

void cameraRayLanes(const CameraRays& camera, const PassKey& key, int left, int bottom, int block,
                    bool centres, RayHitBlock& rays, UintLanes& seeds)
{
    FloatLanes x, y;
    const int blockLeft = left + laneX(block, 0), blockBottom = bottom + laneY(block, 0);
    pixelPoints(key, blockLeft, blockBottom, centres, x, y, seeds);
    raysThrough(camera, x, y, rays.ray);
}

void centreRayLanes(const CameraRays& camera, int left, int bottom, int block, RayHitBlock& rays)
{
    FloatLanes x, y;
    pixelCentres(left + laneX(block, 0), bottom + laneY(block, 0), x, y);
    raysThrough(camera, x, y, rays.ray);
}

void depthLanes(const CameraRays& camera, int left, int bottom, int block,
                const SurfaceLanes& surface, FloatLanes& along, float* depth)
{
    const int blockLeft = left + laneX(block, 0), blockBottom = bottom + laneY(block, 0);
    if (surface.terminatorLanes)
    {
        SurfaceLanes onTriangles = surface;
        dropTerminatorOffset(onTriangles, kAllLanes);
        planeDistances(camera, blockLeft, blockBottom, onTriangles, along);
    }
    else
        planeDistances(camera, blockLeft, blockBottom, surface, along);
    windowDepths(camera, blockLeft, blockBottom, surface.hits, along, depth);
}

} // namespace osgRayTrace::engine
