// PhotonGather.h - radiance that a surface sends to the eye from the photons around a point.
// Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/PhotonMap.h"
#include "osgRayTrace/shading/Bsdf.h"

namespace osgRayTrace::engine
{

/// Where photons are looked for and what the surface does with them.
struct GatherPoint
{
    PhotonQuery query;
    Vec3 wo{0.0f};          ///< unit, world, towards the eye; not used by gatherDiffuse
    const Bsdf* bsdf = nullptr;
    bool directOnly = false; ///< photons that met another than a mirror-like surface are left out
};

/// The largest radius from least to largest within which there are no more than kRadiusPhotons photons; least if
/// there are more in any. It ends where the next photon is, which is not part of the disc: so what the very photons
/// that chose the radius say is right in the mean where their density is even [Loftsgaarden65], also with bounds.
float radiusOf(const PhotonMap& map, PhotonQuery query, float least, float largest);
constexpr uint32_t kRadiusPhotons = 16;

/// Sum over the photons of the disc of f times power [W/sr]: radiance is that over pi radius^2. A Lambert
/// surface.
PhotonSum gatherDiffuse(const PhotonMap& map, const PhotonQuery& query, Vec3 albedo);

/// Any surface, its mirror-like lobes left out; from both sides if it transmits.
PhotonSum gatherBsdf(const PhotonMap& map, const GatherPoint& point);

} // namespace osgRayTrace::engine
