// CameraLanes.h - camera rays and window depths of a block of pixels. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/integrators/shared/Integrator.h"

namespace osgRayTrace::engine
{

/// Rays through one point of each pixel of a block of a tile, and the seeds of these pixels. The
/// points are those of the pass, or the pixel centres.
void cameraRayLanes(const CameraRays& camera, const PassKey& key, int left, int bottom, int block,
                    bool centres, RayHitBlock& rays, UintLanes& seeds);

/// The same through the pixel centres, for what needs no random numbers.
void centreRayLanes(const CameraRays& camera, int left, int bottom, int block, RayHitBlock& rays);

/// Of the surfaces at the pixel centres, where the centre's ray meets the plane of the triangle
/// that the sample hit: along, s of the camera's rays there, infinity where nothing was hit; and
/// the window depth in [0,1], 1 where nothing was.
void depthLanes(const CameraRays& camera, int left, int bottom, int block,
                const SurfaceLanes& surface, FloatLanes& along, float* depth);

} // namespace osgRayTrace::engine
