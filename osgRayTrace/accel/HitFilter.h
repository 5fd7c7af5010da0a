// HitFilter.h - surfaces that let some rays pass: alpha, alpha test, culled faces, panes. Layer:
// accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/HitRule.h"
#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/accel/SurfaceTable.h"
#include "osgRayTrace/shading/MaterialTable.h"

namespace osgRayTrace::engine
{

/// Decides which hits stop their rays. Embree asks for each hit on a mesh that a partial material
/// is on, for rays of every kind: camera, shadow, mirror, bounce and photon. A surface of opacity a
/// stops a ray with probability a, so in the mean 1 - a of the light gets through. The chance is a
/// hash of the ray and the triangle: a ray meets the same surfaces on any thread, and surfaces
/// behind each other are independent.
class HitFilter
{
public:
    /// Keeps references to both tables.
    HitFilter(const SurfaceTable& surfaces, const MaterialTable& materials)
        : _surfaces(surfaces), _materials(materials)
    {
    }

    struct Candidate
    {
        uint32_t instance, primitive;
        float u, v;
        Vec3 origin, direction; ///< in the space of the mesh
        bool front;             ///< counter-clockwise side hit, in the space of the mesh
    };

    bool stops(const Candidate& candidate, HitRule rule) const;

    /// Returns whether all rays stop at the surface that are not told to pass panes.
    bool isSolid(uint32_t instance) const
    {
        const MaterialRecord& record = _materials[_surfaces[instance].material];
        return !record.partial && !record.interface;
    }

    /// Returns whether shadow rays may pass the surface as panes: see PaneCrossings.
    bool isPane(uint32_t instance) const { return _materials[_surfaces[instance].material].pane; }

private:
    const SurfaceTable& _surfaces;
    const MaterialTable& _materials;
};

/// Returns true if rays may pass a surface that their masks let them meet. If there are masks,
/// camera rays never meet what is hidden from the camera, and all others do not pass it unless it
/// is transparent or a pane as well.
bool needsFilter(const MaterialRecord& record, bool masks);

/// Sets HitFilter as the filter of hits on the geometry, an RTCGeometry.
void setHitFilter(void* geometry);

} // namespace osgRayTrace::engine
