// PlacedRays.cpp - takes rays into the space of a placed scene, through it, and back. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/PlacedScenes.h"

namespace osgRayTrace::engine
{

namespace
{

/// Of N rays, as Embree has them: each coordinate an array of N, tNear between origins and
/// directions.
template <int N> struct alignas(64) Ends
{
    float origin[3 * N];
    float direction[3 * N];
};

/// Their distances stay the same: directions are not made unit.
template <int N>
OSGRAYTRACE_INLINE void takeIn(const PlacedScene& placed, float* rays, Ends<N>& outside)
{
    const float* const m = placed.localFromEngine;
    const float xx = m[0], yx = m[1], zx = m[2], xy = m[3], yy = m[4], zy = m[5];
    const float xz = m[6], yz = m[7], zz = m[8], x0 = m[9], y0 = m[10], z0 = m[11];
    OSGRAYTRACE_SIMD
    for (int i = 0; i < N; ++i)
    {
        const float ox = rays[i], oy = rays[N + i], oz = rays[2 * N + i];
        const float dx = rays[4 * N + i], dy = rays[5 * N + i], dz = rays[6 * N + i];
        outside.origin[i] = ox;
        outside.origin[N + i] = oy;
        outside.origin[2 * N + i] = oz;
        outside.direction[i] = dx;
        outside.direction[N + i] = dy;
        outside.direction[2 * N + i] = dz;
        rays[i] = x0 + xx * ox + xy * oy + xz * oz;
        rays[N + i] = y0 + yx * ox + yy * oy + yz * oz;
        rays[2 * N + i] = z0 + zx * ox + zy * oy + zz * oz;
        rays[4 * N + i] = xx * dx + xy * dy + xz * dz;
        rays[5 * N + i] = yx * dx + yy * dy + yz * dz;
        rays[6 * N + i] = zx * dx + zy * dy + zz * dz;
    }
}

template <int N> OSGRAYTRACE_INLINE void takeOut(const Ends<N>& outside, float* rays)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < 3 * N; ++i)
    {
        rays[i] = outside.origin[i];
        rays[4 * N + i] = outside.direction[i];
    }
}

template <int N>
OSGRAYTRACE_INLINE void intersectIn(const RTCIntersectFunctionNArguments* args,
                                    const PlacedScene& placed)
{
    auto* const rays = reinterpret_cast<float*>(args->rayhit);
    Ends<N> outside;
    takeIn<N>(placed, rays, outside);
    intersectPart<N>(args, placed.scene);
    takeOut<N>(outside, rays);
}

template <int N>
OSGRAYTRACE_INLINE void occludeIn(const RTCOccludedFunctionNArguments* args,
                                  const PlacedScene& placed)
{
    auto* const rays = reinterpret_cast<float*>(args->ray);
    Ends<N> outside;
    takeIn<N>(placed, rays, outside);
    occludePart<N>(args, placed.scene);
    takeOut<N>(outside, rays);
}

void intersectInPlace(const RTCIntersectFunctionNArguments* args, RTCScene scene)
{
    switch (args->N)
    {
    case 1:
        return intersectPart<1>(args, scene);
    case 4:
        return intersectPart<4>(args, scene);
    case 8:
        return intersectPart<8>(args, scene);
    case 16:
        return intersectPart<16>(args, scene);
    }
}

void occludeInPlace(const RTCOccludedFunctionNArguments* args, RTCScene scene)
{
    switch (args->N)
    {
    case 1:
        return occludePart<1>(args, scene);
    case 4:
        return occludePart<4>(args, scene);
    case 8:
        return occludePart<8>(args, scene);
    case 16:
        return occludePart<16>(args, scene);
    }
}

template <class Arguments> const PlacedScene& placedScene(const Arguments* args)
{
    return (*static_cast<const PlacedScenes*>(args->geometryUserPtr))[args->primID];
}

OSGRAYTRACE_KERNEL
void intersect(const RTCIntersectFunctionNArguments* args)
{
    const PlacedScene& placed = placedScene(args);
    if (placed.instance == kInvalid) return intersectInPlace(args, placed.scene);
    args->context->instID[0] = placed.instance;
    switch (args->N)
    {
    case 1:
        intersectIn<1>(args, placed);
        break;
    case 4:
        intersectIn<4>(args, placed);
        break;
    case 8:
        intersectIn<8>(args, placed);
        break;
    case 16:
        intersectIn<16>(args, placed);
        break;
    }
    args->context->instID[0] = kInvalid;
}

OSGRAYTRACE_KERNEL
void occlude(const RTCOccludedFunctionNArguments* args)
{
    const PlacedScene& placed = placedScene(args);
    if (placed.instance == kInvalid) return occludeInPlace(args, placed.scene);
    args->context->instID[0] = placed.instance;
    switch (args->N)
    {
    case 1:
        occludeIn<1>(args, placed);
        break;
    case 4:
        occludeIn<4>(args, placed);
        break;
    case 8:
        occludeIn<8>(args, placed);
        break;
    case 16:
        occludeIn<16>(args, placed);
        break;
    }
    args->context->instID[0] = kInvalid;
}

} // namespace

void setPlacedQueries(RTCGeometry geometry)
{
    rtcSetGeometryIntersectFunction(geometry, intersect);
    rtcSetGeometryOccludedFunction(geometry, occlude);
}

} // namespace osgRayTrace::engine
