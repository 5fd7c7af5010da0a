// BareEmbree.cpp - packs recorded rays, and traces them on all threads. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/yardsticks/BareEmbree.h"

#include <algorithm>
#include <cstring>

namespace osgRayTrace::bench
{

namespace
{

constexpr std::size_t kChunkPackets = 16; ///< a chunk has as many rays as a tile has pixels

/// Returns full packets; the last one is filled up with copies of its first ray.
std::vector<RTCRay16> packetsOf(const std::vector<RTCRay>& rays)
{
    std::vector<RTCRay16> packets((rays.size() + 15) / 16);
    for (std::size_t i = 0; i < packets.size() * 16; ++i)
    {
        const RTCRay& ray = rays[std::min(i, rays.size() - 1)];
        RTCRay16& packet = packets[i / 16];
        const std::size_t k = i % 16;
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

void closestHits(const engine::Workers& workers, RTCScene scene,
                 const std::vector<RTCRay16>& packets, bool coherent)
{
    inChunks(workers, packets.size(), kChunkPackets,
             [&](std::size_t first, std::size_t last)
             {
                 RTCIntersectContext context;
                 rtcInitIntersectContext(&context);
                 if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
                 alignas(64) RTCRayHit16 packet;
                 for (std::size_t i = first; i < last; ++i)
                 {
                     std::memcpy(&packet.ray, &packets[i], sizeof(packet.ray));
                     std::memset(packet.hit.geomID, 0xff, sizeof(packet.hit.geomID));
                     std::memset(packet.hit.instID, 0xff, sizeof(packet.hit.instID));
                     rtcIntersect16(kAllValid, scene, &context, &packet);
                 }
             });
}

void occlusion(const engine::Workers& workers, RTCScene scene, const std::vector<RTCRay16>& packets)
{
    inChunks(workers, packets.size(), kChunkPackets,
             [&](std::size_t first, std::size_t last)
             {
                 RTCIntersectContext context;
                 rtcInitIntersectContext(&context);
                 alignas(64) RTCRay16 packet;
                 for (std::size_t i = first; i < last; ++i)
                 {
                     std::memcpy(&packet, &packets[i], sizeof(packet));
                     rtcOccluded16(kAllValid, scene, &context, &packet);
                 }
             });
}

void closestHitsSingly(const engine::Workers& workers, RTCScene scene,
                       const std::vector<RTCRay>& rays)
{
    inChunks(workers, rays.size(), kChunkPackets * 16,
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
    inChunks(workers, rays.size(), kChunkPackets * 16,
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
    : _camera(packetsOf(rays.camera)),
      _secondary(packetsOf(rays.secondary)),
      _shadow(packetsOf(rays.shadow)),
      _scene(rays.scene)
{
}

void BarePackets::trace(const engine::Workers& workers) const
{
    closestHits(workers, _scene, _camera, true);
    closestHits(workers, _scene, _secondary, false);
    occlusion(workers, _scene, _shadow);
}

void traceSingly(const RecordedRays& rays, const engine::Workers& workers)
{
    closestHitsSingly(workers, rays.scene, rays.camera);
    closestHitsSingly(workers, rays.scene, rays.secondary);
    occlusionSingly(workers, rays.scene, rays.shadow);
}

} // namespace osgRayTrace::bench
