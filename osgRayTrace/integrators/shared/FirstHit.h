// FirstHit.h - geometry and material seen through the pixel centres. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/integrators/shared/SurfaceSample.h"

namespace osgRayTrace::engine
{

/// The surface that a ray through one pixel centre met first.
struct FirstHit
{
    bool hit = false;
    float distance = kInfinity; ///< from the start of the ray's line: the eye, or the near plane
    Vec3 normal{0.0f};          ///< unit shading normal, towards the viewer
    Vec3 albedo{0.0f};
    Vec3 position{0.0f}; ///< point in engine space
    uint32_t instance = kInvalid;
};

/// The surfaces that the rays through the pixel centres of a block met first. Normals and albedos
/// are 0 in lanes that met nothing. Albedos are those of seenColors, as in SurfaceSample.
struct FirstHitLanes
{
    RayHitBlock rays;
    SurfaceLanes surface;
    Vec3Lanes normal; ///< unit shading normals, towards the viewer
    Vec3Lanes albedo;
};

/// Traces the pixel centres of a block of a tile. The rays meet blended surfaces as the
/// integrator's own camera rays meet them: always, or by chance. For last see surfacesOf.
void firstHitLanes(const PassContext& context, int left, int bottom, int block, FirstHitLanes& hits,
                   LastTriangle* last = nullptr);

/// Sets the first hits of a tile. The index of a hit is block * kLanes + lane.
void firstHits(const PassContext& context, int left, int bottom, FirstHit (&hits)[kTilePixels]);

/// Sets the first hits of a tile as samples for the stages that work on images.
void firstSamples(const PassContext& context, int left, int bottom,
                  SurfaceSample (&samples)[kTilePixels]);

/// Sets the first hits of a block as recordFirstHits records them.
void firstSurfaces(const PassContext& context, int left, int bottom, int block, SurfaceBlock& seen);

/// Records the first hits of the camera rays of a block, as far as the pass wants them. The rays
/// may pass through any points of their pixels. If the camera has a lens, rays through its middle
/// are traced in their place.
void recordFirstHits(const PassContext& context, int left, int bottom, int block,
                     const RayHitBlock& rays, const SurfaceLanes& surface,
                     FirstHitOutputs& outputs);

} // namespace osgRayTrace::engine
