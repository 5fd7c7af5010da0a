// Intersector.cpp - checks rays and hands them to Embree in the width that pays. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/Intersector.h"

#include "osgRayTrace/accel/Embree.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

namespace osgRayTrace::engine
{

namespace
{

/// The largest length of a direction. Embree's distances are products of three lengths, which
/// overflow or vanish beyond these limits. The engine's directions of length 1 are far inside the
/// limits.
constexpr float kLargestDirection = 1e6f;
constexpr float kSmallestDirection = 1e-6f;

/// The largest number of incoherent rays for which a packet does not pay.
constexpr int kFewRays = 2;

OSGRAYTRACE_INLINE bool traceable(float reach, PlainVec3 origin, PlainVec3 direction, float tNear,
                                  float tFar)
{
    // Comparisons with NaN are false, so each comparison refuses NaN. There are no branches, since
    // this function runs on lanes.
    const float distance = std::fabs(origin.x) + std::fabs(origin.y) + std::fabs(origin.z);
    const float length = std::fabs(direction.x) + std::fabs(direction.y) + std::fabs(direction.z);
    return (distance < reach) & (length > kSmallestDirection) & (length < kLargestDirection) &
           (tNear >= 0.0f) & (tNear <= tFar);
}

/// Sets Embree's "valid" array: -1 for lanes that are active and traceable, else 0. Returns the
/// other active lanes.
OSGRAYTRACE_KERNEL
LaneMask checkRays(const RayBlock& ray, float reach, LaneMask active, Lanes<int>& valid)
{
    LaneMask refused = 0;
    OSGRAYTRACE_SIMD_OR(refused)
    for (int i = 0; i < kLanes; ++i)
    {
        const bool ok = traceable(reach, plainOrigin(ray, i), plainDirection(ray, i), ray.tNear[i],
                                  ray.tFar[i]);
        const uint32_t good = maskOf(ok);
        valid[i] = static_cast<int>(good & laneBit(active, i));
        refused |= bitOfLane(~good, i);
    }
    return refused & active;
}

/// The least number of coherent shadow rays whose packet is filled up with copies of one of them.
/// Embree traces the rays of a packet one by one where few of them meet a subtree, as is soon so in
/// a packet with idle lanes: in the Cornell box such packets take 2.6 times as long as filled ones.
constexpr int kMostlyFull = 8;

/// Sets filled to the rays of a block, with copies of ray number from, whose id is kInvalid, in the
/// lanes that are not valid.
OSGRAYTRACE_KERNEL
void fillIdle(const RayBlock& ray, const Lanes<int>& valid, int from, RayBlock& filled)
{
    const PlainVec3 origin = plainOrigin(ray, from), direction = plainDirection(ray, from);
    const float tNear = ray.tNear[from], tFar = ray.tFar[from];
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const auto own = static_cast<uint32_t>(valid[i]);
        setRay(filled, i, select(own, plainOrigin(ray, i), origin),
               select(own, plainDirection(ray, i), direction), select(own, ray.tNear[i], tNear),
               select(own, ray.tFar[i], tFar));
        filled.id[i] = ray.id[i] | ~own;
    }
}

alignas(64) const Lanes<int> kAllValid = {
    {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1}};

/// Sets tFar of the lanes to that of the rays of a block that was filled up.
OSGRAYTRACE_KERNEL
void takeEnds(const RayBlock& filled, const Lanes<int>& valid, RayBlock& ray)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        ray.tFar[i] = select(static_cast<uint32_t>(valid[i]), filled.tFar[i], ray.tFar[i]);
}

bool areFew(LaneMask rays)
{
    for (int i = 0; i < kFewRays; ++i)
        rays &= rays - 1;
    return rays == 0;
}

/// The types of Embree's packets that are narrower than a block.
template <int Width> struct PacketTypes;
template <> struct PacketTypes<4>
{
    using Ray = RTCRay4;
    using RayHit = RTCRayHit4;
};
template <> struct PacketTypes<8>
{
    using Ray = RTCRay8;
    using RayHit = RTCRayHit8;
};

/// Copies rays first..first+Width-1 of a block into a packet, and back.
template <int Width>
void loadRays(const RayBlock& block, int first, typename PacketTypes<Width>::Ray& packet)
{
    const std::size_t bytes = Width * sizeof(float);
    std::memcpy(packet.org_x, &block.originX[first], bytes);
    std::memcpy(packet.org_y, &block.originY[first], bytes);
    std::memcpy(packet.org_z, &block.originZ[first], bytes);
    std::memcpy(packet.tnear, &block.tNear[first], bytes);
    std::memcpy(packet.dir_x, &block.directionX[first], bytes);
    std::memcpy(packet.dir_y, &block.directionY[first], bytes);
    std::memcpy(packet.dir_z, &block.directionZ[first], bytes);
    std::memcpy(packet.time, &block.time[first], bytes);
    std::memcpy(packet.tfar, &block.tFar[first], bytes);
    std::memcpy(packet.mask, &block.mask[first], bytes);
    std::memcpy(packet.id, &block.id[first], bytes);
    std::memcpy(packet.flags, &block.flags[first], bytes);
}

template <int Width>
void storeHits(const typename PacketTypes<Width>::RayHit& packet, int first, RayHitBlock& block)
{
    const std::size_t bytes = Width * sizeof(float);
    std::memcpy(&block.ray.tFar[first], packet.ray.tfar, bytes);
    std::memcpy(&block.u[first], packet.hit.u, bytes);
    std::memcpy(&block.v[first], packet.hit.v, bytes);
    std::memcpy(&block.primitive[first], packet.hit.primID, bytes);
    std::memcpy(&block.geometry[first], packet.hit.geomID, bytes);
    std::memcpy(&block.instance[first], packet.hit.instID[0], bytes);
}

/// Finds the closest hits of a block, packet by packet.
template <int Width>
void intersectPackets(QueryArguments& arguments, RTCScene scene, const Lanes<int>& valid,
                      RayHitBlock& block)
{
    for (int first = 0; first < kLanes; first += Width)
    {
        alignas(4 * Width) typename PacketTypes<Width>::RayHit packet;
        alignas(4 * Width) int packetValid[Width];
        std::memcpy(packetValid, &valid[first], sizeof(packetValid));
        loadRays<Width>(block.ray, first, packet.ray);
        std::memset(packet.hit.geomID, 0xff, Width * sizeof(unsigned));
        std::memset(packet.hit.instID[0], 0xff, Width * sizeof(unsigned));
        arguments.intersect(packetValid, scene, &packet);
        storeHits<Width>(packet, first, block);
    }
}

/// Finds the occlusion of a block, packet by packet.
template <int Width>
void occludePackets(QueryArguments& arguments, RTCScene scene, const Lanes<int>& valid,
                    RayBlock& block)
{
    for (int first = 0; first < kLanes; first += Width)
    {
        alignas(4 * Width) typename PacketTypes<Width>::Ray packet;
        alignas(4 * Width) int packetValid[Width];
        std::memcpy(packetValid, &valid[first], sizeof(packetValid));
        loadRays<Width>(block, first, packet);
        arguments.occluded(packetValid, scene, &packet);
        std::memcpy(&block.tFar[first], packet.tfar, sizeof(packet.tfar));
    }
}

RTCRay singleRay(Vec3 origin, Vec3 direction, float tNear, float tFar, HitRule rule = {})
{
    RTCRay ray;
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.tnear = tNear;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.time = 0.0f;
    ray.tfar = tFar;
    ray.mask = maskOfRays(rule);
    ray.id = 0;
    ray.flags = 0;
    return ray;
}

RTCRay singleRay(const RayBlock& block, int lane, HitRule rule = {})
{
    RTCRay ray =
        singleRay(Vec3(block.originX[lane], block.originY[lane], block.originZ[lane]),
                  Vec3(block.directionX[lane], block.directionY[lane], block.directionZ[lane]),
                  block.tNear[lane], block.tFar[lane], rule);
    ray.id = static_cast<unsigned int>(lane); // by which PaneCrossings knows the lane
    return ray;
}

} // namespace

Intersector::Intersector(void* embreeScene, int nativeWidth, float reach, const HitFilter* filter)
    : _scene(embreeScene), _nativeWidth(nativeWidth), _reach(reach), _filter(filter)
{
}

LaneMask Intersector::closestHits(RayHitBlock& block, LaneMask active, Coherence coherence,
                                  HitRule rule) const
{
    OSGRAYTRACE_ASSERT(active <= kAllLanes);
    Lanes<int> valid;
    const LaneMask refused = checkRays(block.ray, _reach, active, valid);
    std::memset(&block.geometry, 0xff, sizeof(block.geometry));
    std::memset(&block.instance, 0xff, sizeof(block.instance));
    query(block, valid, active, coherence, rule);
    return refused;
}

void Intersector::query(RayHitBlock& block, const Lanes<int>& valid, LaneMask active,
                        Coherence coherence, HitRule rule) const
{
    const auto scene = static_cast<RTCScene>(_scene);
    std::fill(std::begin(block.ray.mask.v), std::end(block.ray.mask.v), maskOfRays(rule));
    QueryArguments arguments(coherence == Coherence::Coherent, _filter, rule);
    const bool packets =
        coherence == Coherence::Coherent || (_nativeWidth == 16 && !areFew(active));
    if (packets && _nativeWidth == 16)
        return arguments.intersect(valid.v, scene, reinterpret_cast<RTCRayHit16*>(&block));
    if (packets && _nativeWidth == 8) return intersectPackets<8>(arguments, scene, valid, block);
    if (packets && _nativeWidth == 4) return intersectPackets<4>(arguments, scene, valid, block);
    for (int i = 0; i < kLanes; ++i)
    {
        if (!valid[i]) continue;
        RTCRayHit single;
        single.ray = singleRay(block.ray, i, rule);
        single.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        single.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        arguments.intersect(scene, &single);
        block.ray.tFar[i] = single.ray.tfar;
        block.u[i] = single.hit.u;
        block.v[i] = single.hit.v;
        block.primitive[i] = single.hit.primID;
        block.geometry[i] = single.hit.geomID;
        block.instance[i] = single.hit.instID[0];
    }
}

LaneMask Intersector::occlusion(RayBlock& block, LaneMask active, Coherence coherence,
                                PaneCrossings* crossings) const
{
    OSGRAYTRACE_ASSERT(active <= kAllLanes);
    const auto scene = static_cast<RTCScene>(_scene);
    Lanes<int> valid;
    const LaneMask refused = checkRays(block, _reach, active, valid);

    // The coherent flag is never set here: the flag makes occlusion packets slower, and with
    // instances Embree 3.13.5 may not return at all.
    QueryArguments query(false, _filter, kShadowRays, crossings);
    if (crossings)
        for (int i = 0; i < kLanes; ++i)
            block.id[i] = static_cast<uint32_t>(i);
    // Four shadow rays go different ways as soon as two do: on CPUs of that width shadow rays are
    // traced one by one, like other incoherent rays.
    const LaneMask traced = active & ~refused;
    const bool fills = coherence == Coherence::Coherent && traced != kAllLanes;
    if (_nativeWidth == 16 && fills && countLanes(traced) >= kMostlyFull)
    {
        RayBlock filled;
        fillIdle(block, valid, firstLane(traced), filled);
        query.occluded(kAllValid.v, scene, reinterpret_cast<RTCRay16*>(&filled));
        takeEnds(filled, valid, block);
    }
    else if (_nativeWidth == 16 && !areFew(active))
        query.occluded(valid.v, scene, reinterpret_cast<RTCRay16*>(&block));
    else if (_nativeWidth == 8 && !areFew(active))
        occludePackets<8>(query, scene, valid, block);
    else
    {
        for (int i = 0; i < kLanes; ++i)
        {
            if (!valid[i]) continue;
            RTCRay single = singleRay(block, i);
            query.occluded(scene, &single);
            block.tFar[i] = single.tfar;
        }
    }
    for (const int i : lanesIn(refused))
        block.tFar[i] = -kInfinity;
    return refused;
}

std::optional<Hit> Intersector::closestHit(Vec3 origin, Vec3 direction, float tNear, float tFar,
                                           HitRule rule) const
{
    if (!traceable(_reach, plainOf(origin), plainOf(direction), tNear, tFar)) return std::nullopt;
    RTCRayHit single;
    single.ray = singleRay(origin, direction, tNear, tFar, rule);
    single.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    single.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    QueryArguments query(false, _filter, rule);
    query.intersect(static_cast<RTCScene>(_scene), &single);
    if (single.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    Hit hit;
    hit.instance = hitInstance(single.hit.geomID, single.hit.instID[0]);
    hit.primitive = single.hit.primID;
    hit.u = single.hit.u;
    hit.v = single.hit.v;
    hit.t = single.ray.tfar;
    return hit;
}

bool Intersector::occluded(Vec3 origin, Vec3 direction, float tNear, float tFar) const
{
    if (!traceable(_reach, plainOf(origin), plainOf(direction), tNear, tFar)) return true;
    RTCRay single = singleRay(origin, direction, tNear, tFar);
    QueryArguments query(false, _filter, kShadowRays);
    query.occluded(static_cast<RTCScene>(_scene), &single);
    return single.tfar < 0.0f;
}

} // namespace osgRayTrace::engine
