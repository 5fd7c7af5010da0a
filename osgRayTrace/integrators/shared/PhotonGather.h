// PhotonGather.h - radiance that a surface sends to the eye from the photons around a point.
// Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/PhotonMap.h"
#include "osgRayTrace/shading/Bsdf.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Memory that look-ups fill, so that they need not ask for their own. A tile owns one, and no two
/// look-ups use it at once. What it holds between look-ups is undefined.
struct GatherScratch
{
    std::vector<FoundPhoton> foundLanes; ///< photons of sixteen discs
    std::vector<uint32_t> found;         ///< photons of one disc
    NeighbourDistances distances;
};

/// Where photons are looked up, and what the surfaces there do with them.
struct GatherLanes
{
    PhotonQueryLanes queries;
    Vec3Lanes wo;                ///< unit, world, towards the eye
    const Bsdf* bsdfs = nullptr; ///< one a lane
    LaneMask directOnly = 0; ///< photons that met another than a mirror-like surface are left out
};

/// The largest radius from least to largest within which there are no more than kRadiusPhotons
/// photons; least if there are more in any. It ends where the next photon is, which is not part of
/// the disc: so the mean that the very photons give which chose the radius is right if their
/// density is even [Loftsgaarden65], also with bounds.
float radiusOf(const PhotonMap& map, PhotonQuery query, float least, float largest,
               GatherScratch& scratch);
constexpr uint32_t kRadiusPhotons = 16;

/// Sums f times power over the photons of the discs of Lambert surfaces [W/sr]. Radiance is the sum
/// over pi radius^2. Sums are 0 in lanes that the queries do not use.
void gatherDiffuse(const PhotonMap& map, const PhotonQueryLanes& queries, const Vec3Lanes& albedo,
                   PhotonSumLanes& sums);

/// Sums as gatherDiffuse does for surfaces of any kind, without their mirror-like lobes; from both
/// sides if they transmit. Adds to sums.
void gatherBsdf(const PhotonMap& map, const GatherLanes& points, PhotonSumLanes& sums,
                GatherScratch& scratch);

} // namespace osgRayTrace::engine
