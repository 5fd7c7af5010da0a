// PhotonGather.h - radiance that a surface sends to the eye from the photons around a point.
// Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/PhotonMap.h"
#include "osgRayTrace/shading/Bsdf.h"

namespace osgRayTrace::engine
{

/// Where photons are looked for and what the surfaces do with them.
struct GatherLanes
{
    PhotonQueryLanes queries;
    Vec3Lanes wo;                ///< unit, world, towards the eye
    const Bsdf* bsdfs = nullptr; ///< one a lane
    LaneMask directOnly = 0; ///< photons that met another than a mirror-like surface are left out
};

/// The largest radius from least to largest within which there are no more than kRadiusPhotons
/// photons; least if there are more in any. It ends where the next photon is, which is not part of
/// the disc: so what the very photons that chose the radius say is right in the mean where their
/// density is even [Loftsgaarden65], also with bounds.
float radiusOf(const PhotonMap& map, PhotonQuery query, float least, float largest);
constexpr uint32_t kRadiusPhotons = 16;

/// Sums over the photons of the discs of f times power [W/sr]: radiance is that over pi radius^2.
/// Lambert surfaces. 0 in lanes that the queries do not use.
void gatherDiffuse(const PhotonMap& map, const PhotonQueryLanes& queries, const Vec3Lanes& albedo,
                   PhotonSumLanes& sums);

/// The same of any surfaces, their mirror-like lobes left out; from both sides if they transmit.
/// Added to sums.
void gatherBsdf(const PhotonMap& map, const GatherLanes& points, PhotonSumLanes& sums);

} // namespace osgRayTrace::engine
