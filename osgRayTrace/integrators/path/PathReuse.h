// PathReuse.h - paths that neighbouring pixels share. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/film/Film.h"

namespace osgRayTrace::engine
{

/// Pixels share paths in groups, one pixel of each of the tile's blocks: pixels that
/// share samples share their error, and next to each other they would look like a coarser picture.
/// Which pixel of a block is in which group is random, but the same in all passes of a half: the
/// Sobol points of a group are then as well spread as those of a pixel.
constexpr int kReuseGroups = kLanes;
static_assert(kTileBlocks == kLanes, "a lane for each block");

/// Where the camera rays of a group met diffuse surfaces.
struct FirstSurfaces
{
    Vec3Lanes position, geometricNormal, normal, albedo;
    FloatLanes offset;
    LaneMask lanes = 0;
};

/// A second surface, seen from the side that the path came from.
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
    uint32_t turn[kTileBlocks];         ///< below kLanes
    FirstSurfaces first[kReuseGroups];  ///< lane: block of the pixel
    SecondSurface second[kTilePixels];  ///< of reused paths, pixel by pixel
    LaneMask reused[kReuseGroups] = {}; ///< blocks of their pixels
};

} // namespace osgRayTrace::engine
