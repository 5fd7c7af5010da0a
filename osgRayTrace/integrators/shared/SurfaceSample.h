// SurfaceSample.h - what is seen in the middle of a pixel, for what is done with images. Layer:
// integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <cstdint>

namespace osgRayTrace::engine
{

/// What of the light that is seen in a pixel its surface tells about.
enum class SurfaceKind : uint32_t
{
    Scattering,
    Smooth,   ///< a mirror or clear glass and nothing else: one sees other surfaces in it
    Emitting, ///< a lamp, or unlit
};

/// What the camera ray through the middle of a pixel meets first.
struct SurfaceSample
{
    Vec3 normal;     ///< world space, unit, towards the viewer; 0 where nothing is hit
    float distance;  ///< along the ray [length]; infinity: nothing is hit
    Vec3 albedo;     ///< linear
    uint32_t object; ///< instance + 1; 0 where nothing is hit
    /// By about so much may the viewer move around the point before it looks otherwise [radians].
    /// Infinity: it looks the same from everywhere; 0: a mirror, glass, or a layer that others are
    /// seen through.
    float lobe = kInfinity;
    SurfaceKind kind = SurfaceKind::Scattering;
};

} // namespace osgRayTrace::engine
