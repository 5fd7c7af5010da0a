// HitFilter.h - surfaces that let some rays pass: alpha, alpha test, culled faces. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/HitRule.h"
#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/accel/SurfaceTable.h"
#include "osgRayTrace/shading/MaterialTable.h"

namespace osgRayTrace::engine
{

/// Asked by Embree for each hit on a mesh that a partial material is on, for rays of every kind:
/// camera, shadow, mirror, bounce and photon. A surface of opacity a stops a ray with probability
/// a, so what gets through is 1 - a of the light in the mean. The chance is a hash of the ray and
/// the triangle: the same ray meets the same surfaces whatever thread traces it, and surfaces
/// behind each other are independent.
class HitFilter
{
public:
    /// Both are kept.
    HitFilter(const SurfaceTable& surfaces, const MaterialTable& materials)
        : _surfaces(surfaces), _materials(materials)
    {
    }

    struct Candidate
    {
        uint32_t instance, primitive;
        float u, v;
        Vec3 origin, direction; ///< in the space of the mesh
        bool front;             ///< on the counter-clockwise side, in the space of the mesh
    };

    bool stops(const Candidate& candidate, HitRule rule) const;

private:
    const SurfaceTable& _surfaces;
    const MaterialTable& _materials;
};

/// Has HitFilter asked for hits on the geometry, an RTCGeometry.
void setHitFilter(void* geometry);

} // namespace osgRayTrace::engine
