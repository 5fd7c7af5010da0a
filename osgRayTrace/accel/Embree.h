// Embree.h - Embree 3 and 4 behind the same few names. Layer: accel; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/HitRule.h"
#include "osgRayTrace/accel/PaneCrossings.h"
#include "osgRayTrace/accel/RayBlock.h"

// CMake defines OSGRAYTRACE_EMBREE: the headers of both versions may be there.
#if OSGRAYTRACE_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cstddef>

namespace osgRayTrace::engine
{

class HitFilter;

static_assert(sizeof(RayBlock) == sizeof(RTCRay16), "RayBlock is an RTCRay16");
static_assert(sizeof(RayHitBlock) == sizeof(RTCRayHit16), "RayHitBlock is an RTCRayHit16");
static_assert(offsetof(RayBlock, tFar) == offsetof(RTCRay16, tfar), "fields in Embree's order");
static_assert(offsetof(RayHitBlock, primitive) ==
                  offsetof(RTCRayHit16, hit) + offsetof(RTCHit16, primID),
              "fields in Embree's order");

#if OSGRAYTRACE_EMBREE == 4
using RayQueryContext = RTCRayQueryContext;
#else
using RayQueryContext = RTCIntersectContext;
#endif

/// The bits of the masks of rays and geometries: a ray tests a geometry if the masks have a bit in
/// common. All geometries have the bit of other rays.
constexpr uint32_t kCameraMask = 1u, kOtherMask = 2u, kSubsurfaceMask = 4u, kEveryMask = 7u;

/// Returns the mask of the rays of a rule.
inline uint32_t maskOfRays(HitRule rule)
{
    if (rule.subsurfaceOnly) return kSubsurfaceMask;
    return rule.passesHidden() ? kCameraMask : kOtherMask;
}

/// The context of a query, which its filters are handed.
struct FilterContext : RayQueryContext
{
    const HitFilter* filter = nullptr;
    HitRule rule;
    bool coherent = false;
    PaneCrossings* crossings = nullptr; ///< null: panes stop the rays as other surfaces do
};

/// Traces the rays of a callback through a part of the scene, coherently if the query is coherent.
/// The query goes on with the rays as they then are.
template <int N> void tracePart(const RTCIntersectFunctionNArguments* args, RTCScene scene)
{
    void* const rays = args->rayhit;
#if OSGRAYTRACE_EMBREE == 4
    RTCIntersectArguments part;
    rtcInitIntersectArguments(&part);
    part.context = args->context;
    if (static_cast<const FilterContext*>(args->context)->coherent)
        part.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    if constexpr (N == 1) rtcIntersect1(scene, static_cast<RTCRayHit*>(rays), &part);
    if constexpr (N == 4) rtcIntersect4(args->valid, scene, static_cast<RTCRayHit4*>(rays), &part);
    if constexpr (N == 8) rtcIntersect8(args->valid, scene, static_cast<RTCRayHit8*>(rays), &part);
    if constexpr (N == 16)
        rtcIntersect16(args->valid, scene, static_cast<RTCRayHit16*>(rays), &part);
#else
    RTCIntersectContext* const query = args->context;
    if constexpr (N == 1) rtcIntersect1(scene, query, static_cast<RTCRayHit*>(rays));
    if constexpr (N == 4) rtcIntersect4(args->valid, scene, query, static_cast<RTCRayHit4*>(rays));
    if constexpr (N == 8) rtcIntersect8(args->valid, scene, query, static_cast<RTCRayHit8*>(rays));
    if constexpr (N == 16)
        rtcIntersect16(args->valid, scene, query, static_cast<RTCRayHit16*>(rays));
#endif
}

/// Traces the rays of an occlusion callback through a part of the scene; occlusion has no coherent
/// queries.
template <int N> void tracePart(const RTCOccludedFunctionNArguments* args, RTCScene scene)
{
    void* const rays = args->ray;
#if OSGRAYTRACE_EMBREE == 4
    RTCOccludedArguments part;
    rtcInitOccludedArguments(&part);
    part.context = args->context;
    if constexpr (N == 1) rtcOccluded1(scene, static_cast<RTCRay*>(rays), &part);
    if constexpr (N == 4) rtcOccluded4(args->valid, scene, static_cast<RTCRay4*>(rays), &part);
    if constexpr (N == 8) rtcOccluded8(args->valid, scene, static_cast<RTCRay8*>(rays), &part);
    if constexpr (N == 16) rtcOccluded16(args->valid, scene, static_cast<RTCRay16*>(rays), &part);
#else
    RTCIntersectContext* const query = args->context;
    if constexpr (N == 1) rtcOccluded1(scene, query, static_cast<RTCRay*>(rays));
    if constexpr (N == 4) rtcOccluded4(args->valid, scene, query, static_cast<RTCRay4*>(rays));
    if constexpr (N == 8) rtcOccluded8(args->valid, scene, query, static_cast<RTCRay8*>(rays));
    if constexpr (N == 16) rtcOccluded16(args->valid, scene, query, static_cast<RTCRay16*>(rays));
#endif
}

/// The per-query arguments of either version of Embree, with the coherence flag.
class QueryArguments
{
public:
    QueryArguments(bool coherent, const HitFilter* filter, HitRule rule = {},
                   PaneCrossings* crossings = nullptr)
    {
        _context.filter = filter;
        _context.rule = rule;
        _context.coherent = coherent;
        _context.crossings = crossings;
#if OSGRAYTRACE_EMBREE == 4
        rtcInitRayQueryContext(&_context);
        rtcInitIntersectArguments(&_intersect);
        rtcInitOccludedArguments(&_occluded);
        _intersect.context = _occluded.context = &_context;
        if (coherent) _intersect.flags = _occluded.flags = RTC_RAY_QUERY_FLAG_COHERENT;
#else
        rtcInitIntersectContext(&_context);
        if (coherent) _context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
    }

#if OSGRAYTRACE_EMBREE == 4
    void intersect(const int* valid, RTCScene scene, RTCRayHit16* rays)
    {
        rtcIntersect16(valid, scene, rays, &_intersect);
    }
    void intersect(const int* valid, RTCScene scene, RTCRayHit8* rays)
    {
        rtcIntersect8(valid, scene, rays, &_intersect);
    }
    void intersect(const int* valid, RTCScene scene, RTCRayHit4* rays)
    {
        rtcIntersect4(valid, scene, rays, &_intersect);
    }
    void intersect(RTCScene scene, RTCRayHit* ray)
    {
        rtcIntersect1(scene, ray, &_intersect);
    }
    void occluded(const int* valid, RTCScene scene, RTCRay16* rays)
    {
        rtcOccluded16(valid, scene, rays, &_occluded);
    }
    void occluded(const int* valid, RTCScene scene, RTCRay8* rays)
    {
        rtcOccluded8(valid, scene, rays, &_occluded);
    }
    void occluded(const int* valid, RTCScene scene, RTCRay4* rays)
    {
        rtcOccluded4(valid, scene, rays, &_occluded);
    }
    void occluded(RTCScene scene, RTCRay* ray)
    {
        rtcOccluded1(scene, ray, &_occluded);
    }

private:
    RTCIntersectArguments _intersect;
    RTCOccludedArguments _occluded;
    FilterContext _context;
#else
    void intersect(const int* valid, RTCScene scene, RTCRayHit16* rays)
    {
        rtcIntersect16(valid, scene, &_context, rays);
    }
    void intersect(const int* valid, RTCScene scene, RTCRayHit8* rays)
    {
        rtcIntersect8(valid, scene, &_context, rays);
    }
    void intersect(const int* valid, RTCScene scene, RTCRayHit4* rays)
    {
        rtcIntersect4(valid, scene, &_context, rays);
    }
    void intersect(RTCScene scene, RTCRayHit* ray)
    {
        rtcIntersect1(scene, &_context, ray);
    }
    void occluded(const int* valid, RTCScene scene, RTCRay16* rays)
    {
        rtcOccluded16(valid, scene, &_context, rays);
    }
    void occluded(const int* valid, RTCScene scene, RTCRay8* rays)
    {
        rtcOccluded8(valid, scene, &_context, rays);
    }
    void occluded(const int* valid, RTCScene scene, RTCRay4* rays)
    {
        rtcOccluded4(valid, scene, &_context, rays);
    }
    void occluded(RTCScene scene, RTCRay* ray)
    {
        rtcOccluded1(scene, &_context, ray);
    }

private:
    FilterContext _context;
#endif
};

} // namespace osgRayTrace::engine
