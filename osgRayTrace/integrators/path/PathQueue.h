// PathQueue.h - the paths of a tile, sixteen to a block. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/film/Film.h"

namespace osgRayTrace::engine
{

/// Sixteen paths.
struct PathBlock
{
    RayHitBlock rays;
    Vec3Lanes throughput; ///< beta
    FloatLanes pdfW;      ///< of the direction of the ray; infinite: no light sample could find it
    FloatLanes etaScale;  ///< throughput outside of glass over throughput
    UintLanes seed;       ///< of the pixel
    UintLanes pixel;      ///< block * kLanes + lane, and kScattered
    LaneMask active = 0;
};

/// Set once a path has left a surface that is not a mirror: from then on it does not see the
/// background, which is a backdrop and not a light, and the environment as the light that it is,
/// not interpolated.
constexpr uint32_t kScattered = 0x10000u;
/// PhotonUse::Caustics. Set once photons were looked up on a rough surface; and while the last
/// surface that scattered the path is one that photons know (that rough one, any after it, or a
/// glossy one where the direct ones were looked up), kCausticChain too while it has met mirror-like
/// surfaces since: light that it meets then is theirs.
constexpr uint32_t kTaken = 0x80000u;
constexpr uint32_t kGathered = 0x40000u;
constexpr uint32_t kCausticChain = 0x20000u;
constexpr uint32_t kPixelBits = 0xffffu;

struct PathQueue
{
    PathBlock blocks[kTileBlocks];
    int count = kTileBlocks; ///< of blocks in use
};

/// Moves the paths that go on into as few blocks as possible, in order, and readies their rays.
void compactPaths(PathQueue& paths);

} // namespace osgRayTrace::engine
