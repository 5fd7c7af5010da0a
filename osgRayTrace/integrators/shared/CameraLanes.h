// CameraLanes.h - camera rays and window depths of a block of pixels. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/integrators/shared/Integrator.h"

namespace osgRayTrace::engine
{

/// Sets rays through one point of each pixel of a block of a tile, and the seeds of these pixels.
/// The points are the pixel centres if centres is true, else those of the pass. If the camera has a
/// lens, the rays come from points of it.
void cameraRayLanes(const CameraRays& camera, const PassKey& key, int left, int bottom, int block,
                    bool centres, RayHitBlock& rays, UintLanes& seeds);

/// Sets rays through the pixel centres of a block and the middle of the lens, for work that needs
/// no random numbers.
void centreRayLanes(const CameraRays& camera, int left, int bottom, int block, RayHitBlock& rays);

/// Sets, for each pixel centre of a block, where the centre's ray meets the plane of the triangle
/// that the sample hit. along is s of the camera's rays there, or infinity if nothing was hit.
/// depth is the window depth in [0,1], or 1 if nothing was hit.
void depthLanes(const CameraRays& camera, int left, int bottom, int block,
                const SurfaceLanes& surface, FloatLanes& along, float* depth);

} // namespace osgRayTrace::engine
