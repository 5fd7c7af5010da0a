// PhotonColumns.h - photons as columns, and the test of whether they are in a disc. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/photons/Photon.h"

#include <cmath>

namespace osgRayTrace::engine
{

// A photon's normal is packed into three signed bytes, its edges into seven bits above them, and
// direct into the highest bit.
constexpr uint32_t kDirectBit = 1u << 31;

inline uint32_t packNormal(Vec3 n)
{
    // The addition rounds to the nearest, and halves away from zero.
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

/// Holds what a loop over a block of photons reads. The loop's index counts from the block's first
/// photon and is signed, as vector loads need.
struct PhotonColumns
{
    const float *x, *y, *z, *wiX, *wiY, *wiZ, *r, *g, *b;
    const uint32_t* normal;

    OSGRAYTRACE_INLINE PhotonColumns from(uint32_t k) const
    {
        return {x + k, y + k, z + k, wiX + k, wiY + k, wiZ + k, r + k, g + k, b + k, normal + k};
    }
};

/// Holds a disc of a look-up as loops over photons or lanes take it: see PhotonQuery.
struct PlainDisc
{
    PlainVec3 position, normal;
    float radius2;       ///< square of the radius; if negative, no photon is in the disc
    float planeDistance; ///< photons farther from the disc's plane are not in it
    float gapDistance;   ///< nor are these, unless they are turned: see kGapShare
    int32_t mostEdges;
};

/// Tells whether a photon is in a disc, and where.
struct DiscTest
{
    uint32_t in;     ///< all bits or none
    float distance2; ///< square of the distance from the disc's centre
    float off;       ///< distance from the disc's plane
    float tilt2;     ///< square of the sine of the angle between the normals
};

/// Tests photon k.
OSGRAYTRACE_INLINE DiscTest insideDisc(const PhotonColumns& p, int k, PlainDisc disc)
{
    const PlainVec3 position = disc.position, normal = disc.normal;
    const float dx = p.x[k] - position.x, dy = p.y[k] - position.y, dz = p.z[k] - position.z;
    const float distance2 = dx * dx + dy * dy + dz * dz;
    const float off = std::fabs(dx * normal.x + dy * normal.y + dz * normal.z);
    const float side = p.wiX[k] * normal.x + p.wiY[k] * normal.y + p.wiZ[k] * normal.z;
    const uint32_t packed = p.normal[k];
    const float ownX = byteOf(packed, 0), ownY = byteOf(packed, 8), ownZ = byteOf(packed, 16);
    const float turned = ownX * normal.x + ownY * normal.y + ownZ * normal.z;
    // The length, as three bytes hold it, is not quite 1.
    const float tilt2 = ownX * ownX + ownY * ownY + ownZ * ownZ - turned * turned;
    const float gap = off - disc.gapDistance;
    const uint32_t same = maskOf(gap <= 0.0f) | maskOf(gap * gap <= distance2 * tilt2);
    const uint32_t shortEnough = maskOf(edgesOf(packed) <= disc.mostEdges);
    const uint32_t in = maskOf(distance2 <= disc.radius2) & maskOf(off <= disc.planeDistance) &
                        same & maskOf(side > 0.0f) & maskOf(turned >= kLeastNormalCosine) &
                        shortEnough;
    return {in, distance2, off, tilt2};
}

/// Returns the ratio of photon k's cosines, to the shading normal and to the disc's normal; 0 if
/// the photon is not in the disc or comes from below the shading normal.
OSGRAYTRACE_INLINE float shadingWeight(const PhotonColumns& p, int k, uint32_t in, PlainVec3 normal,
                                       PlainVec3 shadingNormal)
{
    const float geometric = p.wiX[k] * normal.x + p.wiY[k] * normal.y + p.wiZ[k] * normal.z;
    const float shading =
        p.wiX[k] * shadingNormal.x + p.wiY[k] * shadingNormal.y + p.wiZ[k] * shadingNormal.z;
    return select(in & maskOf(shading > 0.0f), shading / geometric, 0.0f);
}

} // namespace osgRayTrace::engine
