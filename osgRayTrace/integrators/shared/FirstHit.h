// FirstHit.h - geometry and material seen through the pixel centres. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/integrators/shared/SurfaceSample.h"

namespace osgRayTrace::engine
{

/// What a ray through one pixel centre met first.
struct FirstHit
{
    bool hit = false;
    float distance = kInfinity; ///< from the start of the ray's line: the eye, or the near plane
    Vec3 normal{0.0f};          ///< shading, unit, towards the viewer
    Vec3 albedo{0.0f};
    Vec3 position{0.0f}; ///< engine space
    uint32_t instance = kInvalid;
};

/// What the rays through the pixel centres of a block met first. Normals and albedos are 0 where
/// nothing. Albedos are linear, as in SurfaceSample.
struct FirstHitLanes
{
    RayHitBlock rays;
    SurfaceLanes surface;
    Vec3Lanes normal; ///< shading, unit, towards the viewer
    Vec3Lanes albedo;
};

/// Of a block of a tile. Blended surfaces are met as the integrator's own camera rays meet them:
/// always, or by chance.
void firstHitLanes(const PassContext& context, int left, int bottom, int block,
                   FirstHitLanes& hits);

/// First hits of a tile, index block * kLanes + lane.
void firstHits(const PassContext& context, int left, int bottom, FirstHit (&hits)[kTilePixels]);

/// The same with what is done with images in mind.
void firstSamples(const PassContext& context, int left, int bottom,
                  SurfaceSample (&samples)[kTilePixels]);

/// The same as recordFirstHits has it.
void firstSurfaces(const PassContext& context, int left, int bottom, int block, SurfaceBlock& seen);

/// What camera rays of a pass tell about their first hits, as far as it is wanted: of block's rays,
/// through whatever points of the pixels.
void recordFirstHits(const PassContext& context, int left, int bottom, int block,
                     const RayHitBlock& rays, const SurfaceLanes& surface,
                     FirstHitOutputs& outputs);

} // namespace osgRayTrace::engine
