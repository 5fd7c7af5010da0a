// LightBsdfs.h - what surfaces of any kind send back of light samples. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/shading/Bsdf.h"

namespace osgRayTrace::engine
{

/// evalBsdf for rays that met surfaces and light from wi, lane by lane. 0 in other lanes, and where
/// light and shading normal do not agree on the side: there it would leak through smooth surfaces.
void evalTowardsLight(const RayBlock& rays, const SurfaceLanes& surface, const Vec3Lanes& normal,
                      const Bsdf* bsdfs, const Vec3Lanes& wi, LaneMask lanes, Vec3Lanes& fCos,
                      FloatLanes& pdfW);

} // namespace osgRayTrace::engine
