// PathReuse.h - paths that neighbouring pixels share. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/film/Film.h"

namespace osgRayTrace::engine
{

/// Pixels share paths in groups of one pixel from each of the tile's blocks: pixels that share
/// samples share their error, and neighbours with the same error would look like a coarser picture.
/// Pixels of a block fall into groups at random, but the groups stay in all passes of a half: the
/// Sobol points of a group are then as well spread as those of a pixel.
constexpr int kReuseGroups = kLanes;
static_assert(kTileBlocks == kLanes, "a lane for each block");

/// FirstSurfaces holds the points at which the camera rays of a group met diffuse surfaces.
struct FirstSurfaces
{
    Vec3Lanes position, geometricNormal, normal, albedo;
    FloatLanes offset;
    LaneMask lanes = 0;
};

/// A SecondSurface is the point of a path's second surface, on the side that the path came from.
struct SecondSurface
{
    Vec3 position, normal;
    float offset;
};

struct ReuseGroups
{
    int groupOf(uint32_t pixel) const
    {
        return static_cast<int>((pixel ^ turn[pixel / kLanes]) % kLanes);
    }
    uint32_t pixelOf(int group, int block) const
    {
        return static_cast<uint32_t>(block * kLanes + (group ^ static_cast<int>(turn[block])));
    }

    bool active = false;
    uint32_t turn[kTileBlocks];         ///< exclusive-or of lane and group, below kLanes
    FirstSurfaces first[kReuseGroups];  ///< a lane for each block
    SecondSurface second[kTilePixels];  ///< second surface of each pixel's reused path
    LaneMask reused[kReuseGroups] = {}; ///< blocks of the pixels with reused paths
};

} // namespace osgRayTrace::engine
