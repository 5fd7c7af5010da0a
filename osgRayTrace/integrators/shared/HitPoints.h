// HitPoints.h - where the camera paths of a tile gather light, kept from pass to pass. Layer:
// integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/shading/Bsdf.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Points at which camera paths take light samples and, if gathering, look up photons: the hit
/// points of progressive photon mapping [Hachisuka08, sect. 4.1]. Sixteen of the same number of
/// bounces; lanes beyond count hold the first one.
struct HitPointBlock
{
    Vec3Lanes position; ///< on the triangle
    Vec3Lanes
        start; ///< of shadow rays: position but for points with a terminator offset, see RayStart
    Vec3Lanes geometricNormal; ///< unit, on the side of the ray
    Vec3Lanes normal;          ///< shading, on that side
    Vec3Lanes direction;       ///< of the ray that came here, unit
    Vec3Lanes throughput;
    Vec3Lanes albedo;             ///< if diffuse
    FloatLanes offset, minCosine; ///< see SurfaceLanes
    UintLanes material, instance;
    UintLanes seed;  ///< of the pixel
    UintLanes flags; ///< of the path
    UintLanes bsdf;  ///< index into HitPoints::bsdfs unless diffuse
    int number = 0;  ///< of bounces before
    int count = 0;
    LaneMask diffuse = 0, transmissive = 0, terminatorLanes = 0, gathering = 0,
             terminating = 0; ///< see Bounce, SurfaceLanes
};

/// Passes of one half of the film that gather at the hit points of the same camera paths. The noise
/// of paths, of where they are in the pixel and of what glossy surfaces make of them, falls with
/// the number of such groups alone, and to follow a path takes no more than a tenth of a pass:
/// longer groups cost more than they save.
constexpr int kPathPasses = 2;

/// Number of the camera paths of a pass: that of the pass which has them where each has its own.
/// Paths of a half are numbered one after the other, as their points fill the pixel evenly in that
/// order, and halves of the film have paths of their own, so that the difference between their
/// means shows the noise of paths, too.
inline int sharedPaths(int pass)
{
    const int half = pass & 1;
    return pass / (2 * kPathPasses) * 2 + half;
}

/// Hit points of one tile for one half of the film, kept for the passes that share them.
struct HitPoints
{
    uint32_t paths = kInvalid; ///< PassKey::index of the camera paths; kInvalid: there are none
    std::vector<HitPointBlock> blocks; ///< by number of bounces
    std::vector<Bsdf> bsdfs;
    std::vector<RgbaLanes> seen; ///< kTileBlocks of the light that the paths met by themselves

    /// Leaves the memory for the next paths.
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
