// SurfaceSample.h - the surface in the middle of a pixel, for work on images. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <cstdint>

namespace osgRayTrace::engine
{

/// The origin of the light that a surface sends to a pixel.
enum class SurfaceKind : uint32_t
{
    Scattering,
    Smooth,   ///< a mirror or clear glass alone, which shows other surfaces
    Emitting, ///< a lamp, or an unlit surface
};

/// The surface that the camera ray through the middle of a pixel meets first.
struct SurfaceSample
{
    Vec3 normal;     ///< unit normal in world space, towards the viewer; 0: nothing is hit
    float distance;  ///< distance along the ray [length]; infinity: nothing is hit
    Vec3 albedo;     ///< linear albedo, with what the surface emits on top: see seenColors
    uint32_t object; ///< instance + 1; 0: nothing is hit
    /// The angle by which the viewer may move around the point before the point looks otherwise,
    /// roughly [radians]. Infinity: the point looks the same from everywhere; 0: a mirror, glass,
    /// or a layer that others are seen through.
    float lobe = kInfinity;
    SurfaceKind kind = SurfaceKind::Scattering;
};

} // namespace osgRayTrace::engine
