// PathQueue.h - the paths of a tile, sixteen to a block. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/integrators/path/PathFlags.h"
#include "osgRayTrace/integrators/shared/MediumRays.h"
#include "osgRayTrace/integrators/shared/RayCones.h"
#include "osgRayTrace/integrators/shared/TreeLights.h"

namespace osgRayTrace::engine
{

/// A PathBlock holds sixteen paths.
struct PathBlock
{
    RayHitBlock rays;
    Vec3Lanes throughput; ///< beta
    FloatLanes pdfW;      ///< density of the direction; infinite: no light sample could find it
    FloatLanes etaScale;  ///< throughput outside of glass over throughput
    UintLanes seed;       ///< seed of the pixel
    UintLanes flags;      ///< words of PathFlags
    ConeLanes cones;      ///< set in scenes with SceneTraits::mipmaps
    FloatLanes depth;     ///< way from the eye to the ray's start, in scenes with SceneTraits::fog
    MediumLanes bodies;   ///< bodies that the rays begin in, in scenes with SceneTraits::media
    TreePoints vertices;  ///< points that the rays left; set in scenes with a LightTree
    LaneMask active = 0;

    PathFlags flagsOf(int lane) const { return PathFlags(flags[lane]); }
};

/// The paths of a tile: one for each pixel, and as many again that split off.
struct PathQueue
{
    static constexpr int kBlocks = 2 * kTileBlocks;

    PathBlock blocks[kBlocks];
    int count = kTileBlocks; ///< number of blocks in use
    int added = 0;           ///< paths behind those blocks, which begin with the next bounce

    /// Returns how many paths may still be added before the next bounce.
    int room() const { return kBlocks * kLanes - count * kLanes - added; }
    bool hasRoom() const { return room() > 0; }
};

/// The place of a path in a queue.
struct PathPlace
{
    PathBlock& block;
    int lane;
};

/// Copies the path in lane i of from to lane k of to, without its vertices and its tFar.
void copyPath(const PathBlock& from, int i, PathBlock& to, int k);

/// Sets the fields that Embree reads of all rays of a packet and that no copy of a path sets.
void clearRays(RayBlock& ray);

/// Adds a copy of the path in lane i of from, which does not bounce before the paths have been
/// compacted. The queue must have room. The vertices are copied if they are set.
PathPlace addPath(PathQueue& paths, const PathBlock& from, int i, bool withVertices);

/// Moves the paths that go on into as few blocks as possible, in order, and sets the tFar of all
/// their rays to infinity. The vertices are moved if they are set.
void compactPaths(PathQueue& paths, bool withVertices);

} // namespace osgRayTrace::engine
