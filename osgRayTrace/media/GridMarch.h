// GridMarch.h - volumes step by step, as osgVolume's shaders draw them. Layer: media.
// SPDX-License-Identifier: MIT
//
// Whitted's integrator shows osgVolume's tiles as OpenGL does, with the same steps, sums and
// roundings of lengths: the laws of MultipassTechnique (VolumeLaw::Cells) and RayTracedTechnique
// (VolumeLaw::Samples) of OpenSceneGraph 3.6.5.
#pragma once

#include "osgRayTrace/media/VolumeLighting.h"

namespace osgRayTrace::engine
{

/// What a volume puts before what is behind it: color + (1 - opacity) * behind.
struct MarchedVolume
{
    float begin = kInfinity; ///< where the ray enters the volume
    Vec3 color{0.0f};
    float opacity = 0.0f;
};

/// Returns what a ray of unit direction sees of a volume whose law is not VolumeLaw::Density
/// between begin and end.
MarchedVolume march(const GridRecord& grid, Vec3 origin, Vec3 direction, float begin, float end,
                    const VolumeLight& light);

} // namespace osgRayTrace::engine
