// BsdfLanes.h - sixteen surfaces that transmit nothing, evaluated at once. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/shading/Bsdf.h"

namespace osgRayTrace::engine
{

constexpr int kLeastBsdfLanes = 3; ///< fewer lanes take less time one by one

/// Holds the BSDFs of lanes, for evalBsdfLanes.
struct BsdfLanes
{
    Vec3Lanes diffuse, reflectance; ///< these and the next members: see Bsdf
    FloatLanes grazing, coat, eta, alpha, coatFraction;
    FloatLanes belowAverage; ///< 1 - E_avg of the base's coat
    UintLanes coated;        ///< mask: there is a base under a coat
    UintLanes shines;        ///< mask: there is reflection that is not mirror-like
    const CoatAlbedoRow* coatRows[kLanes];
};

/// Returns the BSDFs of at least one lane; the other lanes hold the first of these, because vector
/// code reads them.
BsdfLanes bsdfLanes(const Bsdf* bsdfs, LaneMask lanes);

/// Evaluates evalBsdf with its densities for light from the side of wo, for surfaces whose
/// transmission is left out; radiance and importance are the same there. Directions and normals are
/// unit vectors in the world. The result is zero if wo or wi is not above the normal's plane, and
/// in other lanes.
void evalBsdfLanes(const BsdfLanes& bsdfs, const Vec3Lanes& normal, const Vec3Lanes& wo,
                   const Vec3Lanes& wi, LaneMask lanes, Vec3Lanes& fCos, FloatLanes& pdfW);

} // namespace osgRayTrace::engine
