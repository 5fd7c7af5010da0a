// GridMarch.h - volumes step by step, as osgVolume's shaders draw them. Layer: media.
// SPDX-License-Identifier: MIT
//
// Whitted's integrator shows osgVolume's tiles as OpenGL does, with the same steps, sums and
// roundings of lengths: the laws of MultipassTechnique (VolumeLaw::Cells) and RayTracedTechnique
// (VolumeLaw::Samples) of OpenSceneGraph 3.6.5.
#pragma once

#include "osgRayTrace/media/GridTable.h"
#include "osgRayTrace/scene/Light.h"

namespace osgRayTrace::engine
{

/// What a volume puts before what is behind it: color * opacity + (1 - opacity) * behind. That the
/// shaders multiply the sum of their colours by the opacity once more is in color * opacity.
struct MarchedVolume
{
    float begin = kInfinity; ///< where the ray enters the volume
    Vec3 color{0.0f};
    float opacity = 0.0f;
};

/// Returns what a ray of unit direction sees of a volume whose law is not VolumeLaw::Density
/// between begin and end. light: the light with the number 0, which lights volumes that are lit;
/// null: there is none.
MarchedVolume march(const GridRecord& grid, Vec3 origin, Vec3 direction, float begin, float end,
                    const Light* light);

} // namespace osgRayTrace::engine
