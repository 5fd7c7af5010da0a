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

/// By pixel of the tile, for the debug channels: index is block * kLanes + lane.
struct TileDiagnostics
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

struct TileResult
{
    RgbaLanes* rgba = nullptr; ///< kTileBlocks of radiance and coverage, one sample a pixel; finite
    float depth[kTilePixels];  ///< window depth at pixel centres; if wanted
    SurfaceBlock* surfaces = nullptr; ///< kTileBlocks, written with depth; null: nobody wants them
    SurfaceSample* samples = nullptr; ///< kTilePixels, written with depth; null: nobody wants them
    TileCounts counts;
    TileDiagnostics* diagnostics = nullptr; ///< null: nobody wants them
    GatheredPhotons* gathered = nullptr;    ///< needed if photonUse
    HitPoints* hitPoints =
        nullptr; ///< of passes that share camera paths: followed if pathKey is another
};

} // namespace osgRayTrace::engine
