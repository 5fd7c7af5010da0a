// PathReuse.h - what the paths of neighbouring pixels lend each other. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/film/Film.h"

namespace osgRayTrace::engine
{

/// Set in the pixel of a path from its second surface on if others get the light that it finds there,
/// too: the sums of such paths are apart.
constexpr uint32_t kLent = 0x100u;

/// The first surfaces of a block's camera paths, where they are diffuse.
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

struct PathLoans
{
    bool active = false; ///< photons of the local schedule are counted pixel by pixel: then not
    FirstSurfaces first[kTileBlocks];
    SecondSurface second[kTilePixels]; ///< of lent paths
    LaneMask lent[kTileBlocks] = {};
};

} // namespace osgRayTrace::engine
