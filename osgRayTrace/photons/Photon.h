// Photon.h - photons, the discs that they are looked for in, and their sums. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Math.h"

#include <algorithm>
#include <cstdint>

namespace osgRayTrace::engine
{

/// Holds a flux that has arrived at a surface.
struct Photon
{
    Vec3 position{0.0f};
    Vec3 wi{0.0f};           ///< unit, towards the place that the photon came from
    Vec3 power{0.0f};        ///< [W], already divided by the number of emitted photons
    Vec3 normal{0.0f};       ///< the surface's geometric normal, unit, on the side of wi
    uint32_t edges = 0;      ///< number of edges of the path from the light to here
    bool direct = false;     ///< the path has met mirror-like surfaces only
    uint32_t bin = kInvalid; ///< the bin of PhotonGuide that the photon was guided to, if any
};

/// Photon paths are told apart by their number of edges up to this one; longer paths count as this
/// long.
constexpr uint32_t kMostEdges = 127;

/// Holds a disc on a surface that photons are looked for in.
struct PhotonQuery
{
    Vec3 position{0.0f};
    Vec3 normal{0.0f}; ///< geometric, unit, on the side that light is gathered from
    Vec3 shadingNormal{
        0.0f}; ///< unit; power is weighted by the ratio of its cosine to that of normal
    float radius = 0.0f;
    uint32_t mostEdges = kMostEdges; ///< photons of longer paths are left out
};

struct PhotonSum
{
    Vec3 power{0.0f}; ///< [W] that arrives through the disc, each photon counted once
    uint32_t count = 0;
};

/// Holds sixteen discs. Discs near each other read the photons around them once.
struct PhotonQueryLanes
{
    Vec3Lanes position, normal, shadingNormal; ///< see PhotonQuery
    FloatLanes radius;
    uint32_t mostEdges = kMostEdges;
    LaneMask lanes = 0; ///< the lanes in use
};

PhotonQuery laneOf(const PhotonQueryLanes& queries, int i);

struct PhotonSumLanes
{
    Vec3Lanes power; ///< undefined in lanes whose count is 0
    UintLanes count; ///< 0 in lanes that are not in use
};

/// A part of an image, and how points of the scene are projected into the image: see
/// PixelProjection.
struct ImageWindow
{
    Vec3 origin{0.0f};                       ///< of the camera
    Vec3 rowS{0.0f}, rowX{0.0f}, rowY{0.0f}; ///< their products with p - origin are s, x and y
    bool orthographic = false;               ///< if not, the last two are s x and s y
    float left = 0.0f, bottom = 0.0f;        ///< [pixels]
    float right = 0.0f, top = 0.0f;          ///< [pixels]
};

/// Names a photon by its index, and the lanes whose discs hold it.
struct FoundPhoton
{
    uint32_t photon;
    LaneMask lanes;
};

/// Photons near a corner or behind a thin wall do not belong to a surface although they are within
/// the radius. Left out are photons that are farther from the surface's plane than kPlaneShare of
/// the radius, and photons whose own surface is turned away by more than 60 degrees.
constexpr float kPlaneShare = 0.25f;
constexpr float kLeastNormalCosine = 0.5f;

/// A surface that is hardly turned from a disc's plane and yet far from it is another one, behind a
/// gap. On a round body a photon at distance d whose normal differs by the angle a is no farther
/// from the plane than d sin a. Left out are photons that are farther by more than kGapShare of the
/// radius and the rounding of places.
constexpr float kGapShare = 1.0f / 32.0f;

/// Returns how far from its plane a disc takes photons whose surface is not turned from it
/// [length].
inline float gapTolerance(Vec3 position, float radius)
{
    constexpr float kRounding = 0x1p-21f; // of places, over their largest coordinate
    const Vec3 size = glm::abs(position);
    return kGapShare * radius + kRounding * std::max(size.x, std::max(size.y, size.z));
}

} // namespace osgRayTrace::engine
