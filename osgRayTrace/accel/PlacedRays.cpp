// PlacedRays.cpp - takes rays into the space of a placed scene, through it, and back. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/PlacedScenes.h"

namespace osgRayTrace::engine
{

namespace
{

/// The origins and directions of N rays in Embree's layout: each coordinate is an array of N.
/// Embree has tNear between origins and directions.
template <int N> struct alignas(64) Ends
{
    float origin[3 * N];
    float direction[3 * N];
};

/// Takes the rays into the placed scene's space. Distances stay the same: directions are not made
/// unit.
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

float* raysOf(const RTCIntersectFunctionNArguments* args)
{
    return reinterpret_cast<float*>(args->rayhit);
}
float* raysOf(const RTCOccludedFunctionNArguments* args)
{
    return reinterpret_cast<float*>(args->ray);
}

/// Traces the rays as they are.
struct InPlace
{
    template <int N, class Arguments>
    OSGRAYTRACE_INLINE static void trace(const Arguments* args, const PlacedScene& placed)
    {
        tracePart<N>(args, placed.scene);
    }
};

/// Traces the rays in the scene's space and takes them back.
struct InSpaceOfScene
{
    template <int N, class Arguments>
    OSGRAYTRACE_INLINE static void trace(const Arguments* args, const PlacedScene& placed)
    {
        float* const rays = raysOf(args);
        Ends<N> outside;
        takeIn<N>(placed, rays, outside);
        tracePart<N>(args, placed.scene);
        takeOut<N>(outside, rays);
    }
};

/// Calls Way::trace for as many rays as Embree has sent.
template <class Way, class Arguments>
OSGRAYTRACE_INLINE void traceWidth(const Arguments* args, const PlacedScene& placed)
{
    switch (args->N)
    {
    case 1:
        return Way::template trace<1>(args, placed);
    case 4:
        return Way::template trace<4>(args, placed);
    case 8:
        return Way::template trace<8>(args, placed);
    case 16:
        return Way::template trace<16>(args, placed);
    }
}

template <class Arguments> OSGRAYTRACE_INLINE void tracePlaced(const Arguments* args)
{
    const PlacedScene& placed =
        (*static_cast<const PlacedScenes*>(args->geometryUserPtr))[args->primID];
    if (!(placed.mask & maskOfRays(static_cast<const FilterContext*>(args->context)->rule))) return;
    if (placed.instance == kInvalid) return traceWidth<InPlace>(args, placed);
    args->context->instID[0] = placed.instance;
    traceWidth<InSpaceOfScene>(args, placed);
    args->context->instID[0] = kInvalid;
}

OSGRAYTRACE_KERNEL
void intersect(const RTCIntersectFunctionNArguments* args)
{
    tracePlaced(args);
}

OSGRAYTRACE_KERNEL
void occlude(const RTCOccludedFunctionNArguments* args)
{
    tracePlaced(args);
}

} // namespace

void setPlacedQueries(RTCGeometry geometry)
{
    rtcSetGeometryIntersectFunction(geometry, intersect);
    rtcSetGeometryOccludedFunction(geometry, occlude);
}

} // namespace osgRayTrace::engine
