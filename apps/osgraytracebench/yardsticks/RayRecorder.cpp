// RayRecorder.cpp - wraps Embree's calls, and copies their rays. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/yardsticks/RayRecorder.h"

namespace
{

osgRayTrace::bench::RecordedRays* recording = nullptr;

/// This flag is true while Embree traces: calls from within Embree, for parts of the scene, have
/// rays that are recorded already.
thread_local bool tracing = false;

struct Tracing
{
    Tracing() { tracing = true; }
    ~Tracing() { tracing = before; }
    const bool before = tracing;
};

template <class Packet> RTCRay rayOf(const Packet& packet, int i)
{
    RTCRay ray = {};
    ray.org_x = packet.org_x[i];
    ray.org_y = packet.org_y[i];
    ray.org_z = packet.org_z[i];
    ray.tnear = packet.tnear[i];
    ray.dir_x = packet.dir_x[i];
    ray.dir_y = packet.dir_y[i];
    ray.dir_z = packet.dir_z[i];
    ray.tfar = packet.tfar[i];
    ray.mask = 0xffffffffu;
    return ray;
}

std::vector<RTCRay>& closestHitList(const RTCIntersectContext* context)
{
    return context->flags & RTC_INTERSECT_CONTEXT_FLAG_COHERENT ? recording->camera
                                                                : recording->secondary;
}

template <class Packet>
void takeDown(const int* valid, int width, RTCScene scene, const Packet& packet,
              std::vector<RTCRay>& list)
{
    recording->scene = scene;
    for (int i = 0; i < width; ++i)
        if (valid[i]) list.push_back(rayOf(packet, i));
}

void takeDown(RTCScene scene, const RTCRay& ray, std::vector<RTCRay>& list)
{
    recording->scene = scene;
    list.push_back(ray);
}

} // namespace

#pragma GCC visibility push(default) // the linker refuses to wrap with hidden symbols
extern "C"
{

    void __real_rtcIntersect16(const int*, RTCScene, RTCIntersectContext*, RTCRayHit16*);
    void __real_rtcIntersect8(const int*, RTCScene, RTCIntersectContext*, RTCRayHit8*);
    void __real_rtcIntersect4(const int*, RTCScene, RTCIntersectContext*, RTCRayHit4*);
    void __real_rtcIntersect1(RTCScene, RTCIntersectContext*, RTCRayHit*);
    void __real_rtcOccluded16(const int*, RTCScene, RTCIntersectContext*, RTCRay16*);
    void __real_rtcOccluded8(const int*, RTCScene, RTCIntersectContext*, RTCRay8*);
    void __real_rtcOccluded1(RTCScene, RTCIntersectContext*, RTCRay*);

    void __wrap_rtcIntersect16(const int* valid, RTCScene scene, RTCIntersectContext* context,
                               RTCRayHit16* rays)
    {
        if (!tracing && recording) takeDown(valid, 16, scene, rays->ray, closestHitList(context));
        const Tracing now;
        __real_rtcIntersect16(valid, scene, context, rays);
    }

    void __wrap_rtcIntersect8(const int* valid, RTCScene scene, RTCIntersectContext* context,
                              RTCRayHit8* rays)
    {
        if (!tracing && recording) takeDown(valid, 8, scene, rays->ray, closestHitList(context));
        const Tracing now;
        __real_rtcIntersect8(valid, scene, context, rays);
    }

    void __wrap_rtcIntersect4(const int* valid, RTCScene scene, RTCIntersectContext* context,
                              RTCRayHit4* rays)
    {
        if (!tracing && recording) takeDown(valid, 4, scene, rays->ray, closestHitList(context));
        const Tracing now;
        __real_rtcIntersect4(valid, scene, context, rays);
    }

    void __wrap_rtcIntersect1(RTCScene scene, RTCIntersectContext* context, RTCRayHit* ray)
    {
        if (!tracing && recording) takeDown(scene, ray->ray, closestHitList(context));
        const Tracing now;
        __real_rtcIntersect1(scene, context, ray);
    }

    void __wrap_rtcOccluded16(const int* valid, RTCScene scene, RTCIntersectContext* context,
                              RTCRay16* rays)
    {
        if (!tracing && recording) takeDown(valid, 16, scene, *rays, recording->shadow);
        const Tracing now;
        __real_rtcOccluded16(valid, scene, context, rays);
    }

    void __wrap_rtcOccluded8(const int* valid, RTCScene scene, RTCIntersectContext* context,
                             RTCRay8* rays)
    {
        if (!tracing && recording) takeDown(valid, 8, scene, *rays, recording->shadow);
        const Tracing now;
        __real_rtcOccluded8(valid, scene, context, rays);
    }

    void __wrap_rtcOccluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* ray)
    {
        if (!tracing && recording) takeDown(scene, *ray, recording->shadow);
        const Tracing now;
        __real_rtcOccluded1(scene, context, ray);
    }

} // extern "C"
#pragma GCC visibility pop

namespace osgRayTrace::bench
{

RayRecorder::RayRecorder(RecordedRays& rays)
{
    recording = &rays;
}

RayRecorder::~RayRecorder()
{
    recording = nullptr;
}

} // namespace osgRayTrace::bench
