// BareEmbree.cpp - packs recorded rays, and traces them on all threads. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/yardsticks/BareEmbree.h"

#include <algorithm>
#include <cstring>

namespace osgRayTrace::bench
{

namespace
{

constexpr std::size_t kChunkRays = 256; ///< a chunk has as many rays as a tile has pixels

/// The packets that Embree traces as one on some CPUs, by their number of rays.
template <int N> struct Packets;
template <> struct Packets<16>
{
    using Ray = RTCRay16;
    using RayHit = RTCRayHit16;
    static constexpr auto intersect = [](auto... arguments) { rtcIntersect16(arguments...); };
    static constexpr auto occluded = [](auto... arguments) { rtcOccluded16(arguments...); };
};
template <> struct Packets<8>
{
    using Ray = RTCRay8;
    using RayHit = RTCRayHit8;
    static constexpr auto intersect = [](auto... arguments) { rtcIntersect8(arguments...); };
    static constexpr auto occluded = [](auto... arguments) { rtcOccluded8(arguments...); };
};
template <> struct Packets<4>
{
    using Ray = RTCRay4;
    using RayHit = RTCRayHit4;
    static constexpr auto intersect = [](auto... arguments) { rtcIntersect4(arguments...); };
    static constexpr auto occluded = [](auto... arguments) { rtcOccluded4(arguments...); };
};

/// Returns full packets; the last one is filled up with copies of the last ray.
template <int N> std::vector<typename Packets<N>::Ray> packetsOf(const std::vector<RTCRay>& rays)
{
    std::vector<typename Packets<N>::Ray> packets((rays.size() + N - 1) / N);
    for (std::size_t i = 0; i < packets.size() * N; ++i)
    {
        const RTCRay& ray = rays[std::min(i, rays.size() - 1)];
        auto& packet = packets[i / N];
        const std::size_t k = i % N;
        packet.org_x[k] = ray.org_x;
        packet.org_y[k] = ray.org_y;
        packet.org_z[k] = ray.org_z;
        packet.tnear[k] = ray.tnear;
        packet.dir_x[k] = ray.dir_x;
        packet.dir_y[k] = ray.dir_y;
        packet.dir_z[k] = ray.dir_z;
        packet.time[k] = 0.0f;
        packet.tfar[k] = ray.tfar;
        packet.mask[k] = 0xffffffffu;
        packet.id[k] = packet.flags[k] = 0;
    }
    return packets;
}

alignas(64) const
    int kAllValid[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};

/// Calls body(first, last) for ranges of size elements on the workers' threads.
template <class Body>
void inChunks(const engine::Workers& workers, std::size_t size, std::size_t chunk, const Body& body)
{
    workers.forEach((size + chunk - 1) / chunk,
                    [&](std::size_t i) { body(i * chunk, std::min(size, (i + 1) * chunk)); });
}

template <int N>
void closestHits(const engine::Workers& workers, RTCScene scene,
                 const std::vector<typename Packets<N>::Ray>& packets, bool coherent)
{
    inChunks(workers, packets.size(), kChunkRays / N,
             [&](std::size_t first, std::size_t last)
             {
                 RTCIntersectContext context;
                 rtcInitIntersectContext(&context);
                 if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
                 alignas(64) typename Packets<N>::RayHit packet;
                 for (std::size_t i = first; i < last; ++i)
                 {
                     std::memcpy(&packet.ray, &packets[i], sizeof(packet.ray));
                     std::memset(packet.hit.geomID, 0xff, sizeof(packet.hit.geomID));
                     std::memset(packet.hit.instID, 0xff, sizeof(packet.hit.instID));
                     Packets<N>::intersect(kAllValid, scene, &context, &packet);
                 }
             });
}

template <int N>
void occlusion(const engine::Workers& workers, RTCScene scene,
               const std::vector<typename Packets<N>::Ray>& packets)
{
    inChunks(workers, packets.size(), kChunkRays / N,
             [&](std::size_t first, std::size_t last)
             {
                 RTCIntersectContext context;
                 rtcInitIntersectContext(&context);
                 alignas(64) typename Packets<N>::Ray packet;
                 for (std::size_t i = first; i < last; ++i)
                 {
                     std::memcpy(&packet, &packets[i], sizeof(packet));
                     Packets<N>::occluded(kAllValid, scene, &context, &packet);
                 }
             });
}

/// Returns what traces the rays in packets of N.
template <int N> std::function<void(const engine::Workers&)> tracerOf(const RecordedRays& rays)
{
    return [camera = packetsOf<N>(rays.camera), secondary = packetsOf<N>(rays.secondary),
            shadow = packetsOf<N>(rays.shadow), scene = rays.scene](const engine::Workers& workers)
    {
        closestHits<N>(workers, scene, camera, true);
        closestHits<N>(workers, scene, secondary, false);
        occlusion<N>(workers, scene, shadow);
    };
}

/// Tells whether Embree traces packets as wide as the property says as one on this CPU.
bool isNative(RTCScene scene, RTCDeviceProperty property)
{
    const RTCDevice device = rtcGetSceneDevice(scene); // which is retained
    const bool native = rtcGetDeviceProperty(device, property) != 0;
    rtcReleaseDevice(device);
    return native;
}

void closestHitsSingly(const engine::Workers& workers, RTCScene scene,
                       const std::vector<RTCRay>& rays)
{
    inChunks(workers, rays.size(), kChunkRays,
             [&](std::size_t first, std::size_t last)
             {
                 RTCIntersectContext context;
                 rtcInitIntersectContext(&context);
                 for (std::size_t i = first; i < last; ++i)
                 {
                     RTCRayHit ray;
                     ray.ray = rays[i];
                     ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
                     rtcIntersect1(scene, &context, &ray);
                 }
             });
}

void occlusionSingly(const engine::Workers& workers, RTCScene scene,
                     const std::vector<RTCRay>& rays)
{
    inChunks(workers, rays.size(), kChunkRays,
             [&](std::size_t first, std::size_t last)
             {
                 RTCIntersectContext context;
                 rtcInitIntersectContext(&context);
                 for (std::size_t i = first; i < last; ++i)
                 {
                     RTCRay ray = rays[i];
                     rtcOccluded1(scene, &context, &ray);
                 }
             });
}

} // namespace

BarePackets::BarePackets(const RecordedRays& rays)
{
    if (isNative(rays.scene, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED))
        _trace = tracerOf<16>(rays);
    else if (isNative(rays.scene, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED))
        _trace = tracerOf<8>(rays);
    else
        _trace = tracerOf<4>(rays);
}

void traceSingly(const RecordedRays& rays, const engine::Workers& workers)
{
    closestHitsSingly(workers, rays.scene, rays.camera);
    closestHitsSingly(workers, rays.scene, rays.secondary);
    occlusionSingly(workers, rays.scene, rays.shadow);
}

} // namespace osgRayTrace::bench
