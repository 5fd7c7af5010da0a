// PhotonColumns.h - photons as columns, and the test of whether they are in a disc. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/photons/Photon.h"

#include <cmath>

namespace osgRayTrace::engine
{

// What is packed with a photon's normal: three signed bytes; edges in seven bits, and direct.
constexpr uint32_t kDirectBit = 1u << 31;

inline uint32_t packNormal(Vec3 n)
{
    // To the nearest, halves away from zero.
    const auto byte = [](float v)
    {
        const float scaled = v * 127.0f;
        return static_cast<uint32_t>(static_cast<int32_t>(scaled + std::copysign(0.5f, scaled))) &
               0xffu;
    };
    return byte(n.x) | byte(n.y) << 8 | byte(n.z) << 16;
}

OSGRAYTRACE_INLINE float byteOf(uint32_t packed, int shift)
{
    return static_cast<float>(static_cast<int32_t>(packed << (24 - shift)) >> 24) * (1.0f / 127.0f);
}

inline Vec3 unpackNormal(uint32_t packed)
{
    return Vec3(byteOf(packed, 0), byteOf(packed, 8), byteOf(packed, 16));
}

OSGRAYTRACE_INLINE int32_t edgesOf(uint32_t packed)
{
    return static_cast<int32_t>((packed >> 24) & kMostEdges);
}

/// What a loop over a block of photons reads; its own index is a signed one, as vector loads need.
struct PhotonColumns
{
    const float *x, *y, *z, *wiX, *wiY, *wiZ, *r, *g, *b;
    const uint32_t* normal;

    OSGRAYTRACE_INLINE PhotonColumns from(uint32_t k) const
    {
        return {x + k, y + k, z + k, wiX + k, wiY + k, wiZ + k, r + k, g + k, b + k, normal + k};
    }
};

/// Bit mask of photon k in the disc around a position, all bits or none. Also how far it is from
/// the disc's centre and from its plane.
OSGRAYTRACE_INLINE uint32_t insideDisc(const PhotonColumns& p, int k, PlainVec3 position,
                                       PlainVec3 normal, int32_t mostEdges, float radius2,
                                       float planeDistance, float& distance2, float& off)
{
    const float dx = p.x[k] - position.x, dy = p.y[k] - position.y, dz = p.z[k] - position.z;
    distance2 = dx * dx + dy * dy + dz * dz;
    off = std::fabs(dx * normal.x + dy * normal.y + dz * normal.z);
    const float side = p.wiX[k] * normal.x + p.wiY[k] * normal.y + p.wiZ[k] * normal.z;
    const uint32_t packed = p.normal[k];
    const float turned =
        byteOf(packed, 0) * normal.x + byteOf(packed, 8) * normal.y + byteOf(packed, 16) * normal.z;
    const uint32_t shortEnough = maskOf(edgesOf(packed) <= mostEdges);
    return maskOf(distance2 <= radius2) & maskOf(off <= planeDistance) & maskOf(side > 0.0f) &
           maskOf(turned >= kLeastNormalCosine) & shortEnough;
}

/// Of photon k and a shading normal, in a disc of that normal: the ratio of its cosines.
OSGRAYTRACE_INLINE float shadingWeight(const PhotonColumns& p, int k, uint32_t in, PlainVec3 normal,
                                       PlainVec3 shadingNormal)
{
    const float geometric = p.wiX[k] * normal.x + p.wiY[k] * normal.y + p.wiZ[k] * normal.z;
    const float shading =
        p.wiX[k] * shadingNormal.x + p.wiY[k] * shadingNormal.y + p.wiZ[k] * shadingNormal.z;
    return select(in & maskOf(shading > 0.0f), shading / geometric, 0.0f);
}

} // namespace osgRayTrace::engine
