// PhotonGather.h - the radiance that surfaces send to the eye from photons. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/PhotonMap.h"
#include "osgRayTrace/shading/Bsdf.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Memory that look-ups fill, so that they need not allocate any. A tile owns one GatherScratch,
/// and no two look-ups use it at once. Its contents between look-ups are undefined.
struct GatherScratch
{
    std::vector<FoundPhoton> foundLanes; ///< photons of sixteen discs
    std::vector<uint32_t> found;         ///< photons of one disc
    NeighbourDistances distances;
};

/// The points at which photons are looked up, and the scattering of the surfaces there.
struct GatherLanes
{
    PhotonQueryLanes queries;
    Vec3Lanes wo;                ///< unit directions towards the eye, world space
    const Bsdf* bsdfs = nullptr; ///< one Bsdf for each lane
    LaneMask directOnly = 0; ///< lanes without photons that have met a surface other than a mirror
};

/// Returns the largest radius from least to largest within which there are no more than
/// kRadiusPhotons photons, or least if even that radius holds more. The disc ends at the next
/// photon, which is not part of the disc. So the mean over the photons that chose the radius is
/// right if their density is even [Loftsgaarden65], also with bounds.
float radiusOf(const PhotonMap& map, PhotonQuery query, float least, float largest,
               GatherScratch& scratch);
constexpr uint32_t kRadiusPhotons = 16;

/// Sets sums to f times power, summed over the photons of the discs of Lambert surfaces [W/sr].
/// Radiance is the sum over pi radius^2. Sums are 0 in lanes that the queries do not use.
void gatherDiffuse(const PhotonMap& map, const PhotonQueryLanes& queries, const Vec3Lanes& albedo,
                   PhotonSumLanes& sums);

/// Adds to sums as gatherDiffuse computes them, for surfaces of any kind, without their mirror-like
/// lobes. Surfaces that transmit gather photons from both sides.
void gatherBsdf(const PhotonMap& map, const GatherLanes& points, PhotonSumLanes& sums,
                GatherScratch& scratch);

/// Returns f cosTheta / cosGeometric of lane i for the light of a photon from the side of wo: the
/// radiance that its flux becomes is that times the flux over an area.
Vec3 scatterPhoton(const GatherLanes& points, const Vec3Lanes& albedo, LaneMask diffuse, int i,
                   const Photon& photon);

} // namespace osgRayTrace::engine
