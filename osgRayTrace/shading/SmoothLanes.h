// SmoothLanes.h - sixteen rays at smooth interfaces: mirrors and clear glass. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/shading/Bsdf.h"

namespace osgRayTrace::engine
{

/// Returns true if the surface has mirror-like lobes and no other.
inline bool isSmoothInterface(const Bsdf& bsdf)
{
    return bsdf.isMirror();
}

/// Holds the members of Bsdf that sampleBsdf reads of a smooth interface.
struct InterfaceLanes
{
    FloatLanes eta, coat, grazing;
    Vec3Lanes reflectance, transmission;

    void set(int lane, const Bsdf& bsdf)
    {
        eta[lane] = bsdf.eta;
        coat[lane] = bsdf.coat;
        grazing[lane] = bsdf.grazing;
        reflectance.x[lane] = bsdf.reflectance.x;
        reflectance.y[lane] = bsdf.reflectance.y;
        reflectance.z[lane] = bsdf.reflectance.z;
        transmission.x[lane] = bsdf.transmission.x;
        transmission.y[lane] = bsdf.transmission.y;
        transmission.z[lane] = bsdf.transmission.z;
    }
};

/// Holds rays at smooth interfaces. Their frames are not needed: both lobes are in the plane of ray
/// and normal.
struct IncidentLanes
{
    const FloatLanes &directionX, &directionY, &directionZ; ///< unit, the way of the rays
    const Vec3Lanes& normal; ///< unit, on the side that the rays come from
};

struct SmoothLanes
{
    LaneMask alive;       ///< other lanes have to be discarded
    LaneMask transmitted; ///< lanes among alive that were refracted
    FloatLanes reflects;  ///< probability of reflection
};

/// Does for lanes what sampleBsdf does for one surface: one Fresnel term chooses the lobe and
/// weighs it. Sets wi (unit, in the space of the normals) and weight of lanes; those of the other
/// lanes stay as they are.
SmoothLanes sampleSmoothLanes(const InterfaceLanes& interfaces, const IncidentLanes& incident,
                              const FloatLanes& uLobe, LaneMask lanes, Transport transport,
                              Vec3Lanes& wi, Vec3Lanes& weight);

} // namespace osgRayTrace::engine
