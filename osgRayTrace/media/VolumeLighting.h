// VolumeLighting.h - the light of osgVolume's LightingProperty, by the gradient of values. Layer:
// media.
// SPDX-License-Identifier: MIT
//
// osgVolume's shaders light a volume by light 0 alone, whatever its colour is, without shadows and
// by angles in the unit cube of the tile: colours are times 0.1 + 0.9 max(0, n l), with n down the
// gradient. Whitted's steps and paths take the same factor.
#pragma once

#include "osgRayTrace/media/GridTable.h"
#include "osgRayTrace/media/VolumeSample.h"

namespace osgRayTrace::engine
{

/// The light that lights volumes which are lit: OpenGL's light 0.
struct VolumeLight
{
    bool isFar = true;    ///< directional
    Vec3 direction{0.0f}; ///< in which light travels, if it is far [engine space]
    Vec3 position{0.0f};  ///< otherwise
};

/// Returns the unit direction along which gradients are lit where a ray leaves the volume at a
/// point [engine space], in the unit cube of the tile; 0: there is none.
Vec3 litDirection(const GridRecord& grid, const VolumeLight& light, Vec3 exit);

/// Returns the step of differences at the rate at which the law looks at the image [unit cube].
/// wayStep: the step along a ray of Whitted's integrator.
inline float gradientStep(const Volume& volume, float wayStep)
{
    constexpr float kOfSamples = 1.0f / 512.0f;
    return volume.law == VolumeLaw::Samples ? kOfSamples : wayStep;
}

/// Returns the length of a step of VolumeLaw::Cells, of which a ray takes a whole number.
inline float cellStep(const Volume& volume)
{
    const VolumeImage& image = *volume.image;
    const auto most =
        static_cast<float>(std::max(image.width, std::max(image.height, image.depth)));
    return 1.0f / most / std::max(volume.sampleRatio, 1e-3f);
}

/// Returns the factor of the colour at a point of the image's unit cube.
float lightScale(const VolumeImage& image, Vec3 p, float step, Vec3 litDirection);

} // namespace osgRayTrace::engine
