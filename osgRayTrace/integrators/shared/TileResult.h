// TileResult.h - what a pass returns for a tile. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/film/Film.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// For one tile and pass.
struct TileCounts
{
    uint64_t cameraRays = 0;
    uint64_t shadowRays = 0;
    uint64_t secondaryRays = 0;
    uint64_t droppedSamples = 0;
};

/// What the debug channels show, by pixel of the tile: block * kLanes + lane.
struct DebugOutputs
{
    float rays[kTilePixels] = {};
    float dropped[kTilePixels] = {};
};

/// What a photon that was guided to a bin of PhotonGuide added to the radiance of a pixel.
struct SeenPhoton
{
    uint32_t bin = kInvalid;
    float radiance = 0.0f; ///< its luminance
};

/// Photon lookups of each pixel's camera path.
struct GatheredPhotons
{
    /// [length] In: radius for this pass, 0 if it is not known yet; then out: the one that was
    /// chosen.
    float radius[kTilePixels] = {};

    // For the local radius schedule, out: what was found, which is then not part of the image.
    bool separate = false;
    uint32_t count[kTilePixels] = {};
    Vec3 flux[kTilePixels] = {}; ///< times the path's throughput [W/sr]

    /// Photons of the pixels that, and seenFirst, are a multiple of seenStride; 0: they are not
    /// wanted.
    std::vector<SeenPhoton> seen;
    uint32_t seenFirst = 0, seenStride = 0;
};

struct HitPoints;
struct SurfaceSample;

/// What the camera rays of a block met first. Where that is nothing, normals and objects are 0.
struct SurfaceBlock
{
    Vec3Lanes normal; ///< shading, unit, towards the viewer
    FloatLanes
        along;       ///< s of CameraRays where the pixel's middle sees its plane; infinity: nothing
    FloatLanes lobe; ///< width of its narrowest lobe [radians]; see SurfaceSample
    UintLanes object; ///< instance + 1
};

/// What the camera rays of a pass tell about what they met first. Written if
/// PassContext::wantsDepth.
struct FirstHitOutputs
{
    float depth[kTilePixels];         ///< window depth at pixel centres
    SurfaceBlock* surfaces = nullptr; ///< kTileBlocks; null: nobody wants them
    SurfaceSample* samples = nullptr; ///< kTilePixels; null: nobody wants them
};

/// What lookups of photons read and write. Needed if PassContext::photonUse is not None.
struct PhotonOutputs
{
    GatheredPhotons* gathered = nullptr;
    /// Of passes that share camera paths: the paths are followed anew if pathKey is another. Null:
    /// no passes share them.
    HitPoints* hitPoints = nullptr;
};

struct TileResult
{
    RgbaLanes* rgba = nullptr; ///< kTileBlocks of radiance and coverage, one sample a pixel; finite
    TileCounts counts;
    FirstHitOutputs firstHits;
    PhotonOutputs photons;
    DebugOutputs* debug = nullptr; ///< null: nobody wants them
};

} // namespace osgRayTrace::engine
