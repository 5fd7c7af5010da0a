// BsdfLanes.h - sixteen surfaces that transmit nothing, evaluated at once. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/shading/Bsdf.h"

namespace osgRayTrace::engine
{

constexpr int kLeastBsdfLanes = 3; ///< fewer take less time one by one

/// The BSDFs of lanes, for evalBsdfLanes.
struct BsdfLanes
{
    Vec3Lanes diffuse, reflectance; ///< and what follows: see Bsdf
    FloatLanes grazing, coat, eta, alpha, coatFraction;
    FloatLanes belowAverage; ///< 1 - E_avg of the base's coat
    UintLanes coated;        ///< mask: there is a base under a coat
    UintLanes shines;        ///< mask: there is reflection that is not mirror-like
    const CoatAlbedoRow* coatRows[kLanes];
};

/// Of at least one lane; the others hold the first of these, as vector code reads them.
BsdfLanes bsdfLanes(const Bsdf* bsdfs, LaneMask lanes);

/// evalBsdf with its densities for light from the side of wo, of surfaces whose transmission is
/// left out; radiance and importance are the same there. Directions and normals in the world, unit.
/// Zero where wo or wi is not above the normal's plane, and in other lanes.
void evalBsdfLanes(const BsdfLanes& bsdfs, const Vec3Lanes& normal, const Vec3Lanes& wo,
                   const Vec3Lanes& wi, LaneMask lanes, Vec3Lanes& fCos, FloatLanes& pdfW);

} // namespace osgRayTrace::engine
