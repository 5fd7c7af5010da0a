// HitPoints.h - points of a tile at which camera paths gather light. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/shading/Bsdf.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Points at which camera paths take light samples and, in lanes of gathering, look up photons: the
/// hit points of progressive photon mapping [Hachisuka08, sect. 4.1]. A block holds sixteen points
/// of the same number of bounces. Lanes beyond count hold a copy of the first point.
struct HitPointBlock
{
    Vec3Lanes position; ///< point on the triangle
    Vec3Lanes
        start; ///< start of shadow rays: position unless there is a terminator offset, see RayStart
    Vec3Lanes geometricNormal; ///< unit normal of the triangle, on the side of the ray
    Vec3Lanes normal;          ///< shading normal, on the side of the ray
    Vec3Lanes direction;       ///< unit direction of the ray that met the point
    Vec3Lanes throughput;
    Vec3Lanes albedo;             ///< albedo of diffuse lanes
    FloatLanes offset, minCosine; ///< see SurfaceLanes
    UintLanes material, instance;
    UintLanes seed;  ///< seed of the pixel
    UintLanes flags; ///< flags of the path
    UintLanes bsdf;  ///< index into HitPoints::bsdfs unless diffuse
    int number = 0;  ///< number of bounces before the point
    int count = 0;
    LaneMask diffuse = 0, transmissive = 0, terminatorLanes = 0, gathering = 0,
             terminating = 0; ///< see Bounce, SurfaceLanes
};

/// The number of passes of one half of the film that gather at the hit points of the same camera
/// paths. The noise of paths (of their places in the pixel and of their directions at glossy
/// surfaces) falls with the number of such groups alone. To follow a path takes no more than a
/// tenth of a pass, so longer groups cost more than they save.
constexpr int kPathPasses = 2;

/// Returns the number of the camera paths of a pass: the index of the pass that would trace these
/// paths if each pass had its own. The paths of a half are numbered one after the other, because
/// their points fill the pixel evenly in that order. Halves of the film have paths of their own, so
/// that the difference between the halves' means shows the noise of paths, too.
inline int sharedPaths(int pass)
{
    const int half = pass & 1;
    return pass / (2 * kPathPasses) * 2 + half;
}

/// The hit points of one tile for one half of the film, kept for the passes that share them.
struct HitPoints
{
    uint32_t paths = kInvalid;         ///< PassKey::index of the camera paths; kInvalid: none
    std::vector<HitPointBlock> blocks; ///< blocks in order of the number of bounces
    std::vector<Bsdf> bsdfs;
    std::vector<RgbaLanes> seen; ///< light that the paths met by themselves, kTileBlocks

    /// Removes the paths and keeps the memory for the next paths.
    void clear()
    {
        paths = kInvalid;
        blocks.clear();
        bsdfs.clear();
        seen.clear();
    }

    std::size_t bytes() const
    {
        return blocks.capacity() * sizeof(HitPointBlock) + bsdfs.capacity() * sizeof(Bsdf) +
               seen.capacity() * sizeof(RgbaLanes);
    }
};

} // namespace osgRayTrace::engine
