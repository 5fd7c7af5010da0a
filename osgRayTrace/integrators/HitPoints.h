// HitPoints.h - where the camera paths of a tile gather light, kept from pass to pass. Layer:
// integrators. SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/shading/Bsdf.h"

#include <vector>

namespace osgRayTrace::engine
{

/// A point at which a camera path takes light samples and, if gathering, looks up photons: the hit
/// points of progressive photon mapping [Hachisuka08, sect. 4.1].
struct HitPoint
{
    Vec3 position;        ///< on the triangle
    Vec3 start;           ///< of shadow rays: position but for lifted points, see RayStart
    Vec3 geometricNormal; ///< unit, on the side of the ray
    Vec3 normal;          ///< shading, on that side
    Vec3 direction;       ///< of the ray that came here, unit
    Vec3 throughput;
    Vec3 albedo;  ///< if diffuse
    float offset, steep; ///< see SurfaceLanes
    uint32_t material;
    uint32_t instance;
    uint32_t seed;   ///< of the pixel
    uint32_t pixel;  ///< with the path's flags
    uint32_t bsdf;   ///< index into HitPoints::bsdfs unless diffuse
    uint16_t number; ///< of bounces before
    bool diffuse, through, lifted, gathering, ending; ///< see Bounce, SurfaceLanes
};

/// Of one tile, for all passes in which camera paths are the same.
struct HitPoints
{
    bool traced = false;          ///< the paths were followed; otherwise all else is empty
    std::vector<HitPoint> points; ///< by number of bounces
    std::vector<Bsdf> bsdfs;
    std::vector<RgbaLanes> seen; ///< kTileBlocks of the light that the paths met by themselves

    std::size_t bytes() const
    {
        return points.capacity() * sizeof(HitPoint) + bsdfs.capacity() * sizeof(Bsdf) +
               seen.capacity() * sizeof(RgbaLanes);
    }
};

} // namespace osgRayTrace::engine
