// Photon.h - photons, the discs that they are looked for in, and their sums. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Math.h"

#include <cstdint>

namespace osgRayTrace::engine
{

/// A flux that arrived at a surface.
struct Photon
{
    Vec3 position{0.0f};
    Vec3 wi{0.0f};           ///< unit, towards where it came from
    Vec3 power{0.0f};        ///< [W], already divided by the number of emitted photons
    Vec3 normal{0.0f};       ///< geometric, unit, on the side of wi
    uint32_t edges = 0;      ///< of its path, from the light to here
    bool direct = false;     ///< met mirror-like surfaces only
    uint32_t bin = kInvalid; ///< of PhotonGuide that it was sent to, if it was
};

/// Photon paths are told apart by their number of edges up to here; longer ones count as this.
constexpr uint32_t kMostEdges = 127;

/// A disc on a surface that photons are looked for in.
struct PhotonQuery
{
    Vec3 position{0.0f};
    Vec3 normal{0.0f}; ///< geometric, unit, on the side that light is gathered from
    Vec3 shadingNormal{
        0.0f}; ///< unit; power is weighted by the ratio of its cosine to that of normal
    float radius = 0.0f;
    uint32_t mostEdges = kMostEdges; ///< photons of more are left out
};

struct PhotonSum
{
    Vec3 power{0.0f}; ///< [W] that arrives through the disc, each photon counted once
    uint32_t count = 0;
};

/// Sixteen discs. Those near each other read the photons around them once.
struct PhotonQueryLanes
{
    Vec3Lanes position, normal, shadingNormal; ///< see PhotonQuery
    FloatLanes radius;
    uint32_t mostEdges = kMostEdges;
    LaneMask lanes = 0; ///< in use
};

PhotonQuery laneOf(const PhotonQueryLanes& queries, int i);

struct PhotonSumLanes
{
    Vec3Lanes power; ///< undefined where the count is 0
    UintLanes count; ///< 0 of lanes that are not in use
};

/// A photon, and the lanes whose discs it is in.
struct FoundPhoton
{
    uint32_t photon;
    LaneMask lanes;
};

/// Photons near a corner or behind a thin wall do not belong to a surface although they are within
/// the radius: those farther off its plane than this share of the radius are left out, as are those
/// whose own surface is turned away by more than 60 degrees.
constexpr float kPlaneShare = 0.25f;
constexpr float kLeastNormalCosine = 0.5f;

} // namespace osgRayTrace::engine
