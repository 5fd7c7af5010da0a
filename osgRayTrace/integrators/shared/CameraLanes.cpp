// CameraLanes.cpp - camera rays and window depths of a block of pixels. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/CameraLanes.h"

#include "osgRayTrace/sampling/Warp.h"

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

/// Returns the point at which the ray through a point of the image begins. directionAt returns the
/// direction of that ray, which is not unit.
OSGRAYTRACE_INLINE PlainVec3 originAt(const CameraRays& c, float x, float y)
{
    return mad(plainOf(c.originDy), y, mad(plainOf(c.originDx), x, plainOf(c.origin)));
}

OSGRAYTRACE_INLINE PlainVec3 directionAt(const CameraRays& c, float x, float y)
{
    return mad(plainOf(c.directionDy), y, mad(plainOf(c.directionDx), x, plainOf(c.direction)));
}

OSGRAYTRACE_INLINE void setRayThrough(const CameraRays& c, float x, float y, int i, RayBlock& ray)
{
    const PlainVec3 d = directionAt(c, x, y);
    const float length = std::sqrt(dot(d, d));
    const float inverse = 1.0f / length;
    setRay(ray, i, originAt(c, x, y), d * inverse, c.nearS * length, kInfinity);
}

OSGRAYTRACE_KERNEL
void raysThrough(const CameraRays& camera, const FloatLanes& x, const FloatLanes& y, RayBlock& ray)
{
    const CameraRays c = camera;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        setRayThrough(c, x[i], y[i], i, ray);
}

/// Sets a ray from a point of the lens to where the pinhole's ray is sharp.
OSGRAYTRACE_INLINE void setLensRay(const CameraRays& c, float x, float y, PlainVec3 lens, int i,
                                   RayBlock& ray)
{
    const PlainVec3 through = directionAt(c, x, y);
    const PlainVec3 d = through - lens * dot(plainOf(c.focus), through);
    const float length = std::sqrt(dot(d, d));
    setRay(ray, i, originAt(c, x, y) + lens, d * (1.0f / length), c.nearS * length, kInfinity);
}

/// Returns the point of the lens for (u, v), which is uniform in the unit square as the point is on
/// the lens.
OSGRAYTRACE_INLINE PlainVec3 lensPoint(const CameraRays& c, float u, float v)
{
    float sine, cosine;
    sinCosTurn(u, sine, cosine);
    const float radius = std::sqrt(v);
    return plainOf(c.lensX) * (radius * cosine) + plainOf(c.lensY) * (radius * sine);
}

OSGRAYTRACE_KERNEL
void raysThroughLens(const CameraRays& camera, uint32_t index, const FloatLanes& x,
                     const FloatLanes& y, const UintLanes& seeds, RayBlock& ray)
{
    const CameraRays c = camera;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        float u, v;
        sobol2(index, dimensionSeed(seeds[i], DimensionLens), u, v);
        setLensRay(c, x[i], y[i], lensPoint(c, u, v), i, ray);
    }
}

/// Returns s of the ray through a point of the image at the plane of lane i's surface.
OSGRAYTRACE_INLINE float planeDistance(const CameraRays& c, float x, float y,
                                       const SurfaceLanes& surface, int i)
{
    const PlainVec3 d = directionAt(c, x, y), o = originAt(c, x, y);
    const PlainVec3 n = plainOf(surface.geometricNormal, i);
    const PlainVec3 way = plainOf(surface.position, i) - o;
    const float s = dot(n, way) / dot(n, d);
    // If the plane is seen edge-on, the centre's ray may meet the plane far away: then the depth of
    // the sample itself is used.
    const float sHit = dot(way, d) / dot(d, d);
    const bool usable = (s > 0.5f * sHit) & (s < 2.0f * sHit);
    return select(usable, s, sHit);
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
        along[i] = select(laneBit(hits, i), planeDistance(c, x, y, surface, i), kInfinity);
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
    if (camera.hasLens())
        raysThroughLens(camera, key.index, x, y, seeds, rays.ray);
    else
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
