// LightBsdfs.h - the light samples that surfaces of any kind scatter. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/shading/Bsdf.h"

namespace osgRayTrace::engine
{

/// Sets fCos and pdfW to those of evalBsdf for rays that met surfaces and for light from wi, lane
/// by lane. Both are 0 in other lanes, and in lanes for which isAbove and the shading normal do not
/// agree on the side of the light: there light would leak through smooth surfaces.
void evalTowardsLight(const RayBlock& rays, const SurfaceLanes& surface, const Vec3Lanes& normal,
                      const Bsdf* bsdfs, const Vec3Lanes& wi, LaneMask lanes, Vec3Lanes& fCos,
                      FloatLanes& pdfW);

} // namespace osgRayTrace::engine
