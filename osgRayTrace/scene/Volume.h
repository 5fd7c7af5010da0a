// Volume.h - a three-dimensional image in a box, which absorbs, scatters and emits light. Layer:
// scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/scene/Medium.h"
#include "osgRayTrace/scene/Mesh.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// The number of volumes that a scene may have.
constexpr std::size_t kMostVolumes = 16;

/// Holds voxels, row by row and slice by slice, as bytes or as floats. A look-up is trilinear
/// between the middles of voxels; beyond the outermost middles values fade to 0.
struct VolumeImage
{
    int width = 0, height = 0, depth = 0;
    int channels = 1;           ///< 1: a value; 4: a colour and a value
    std::vector<uint8_t> bytes; ///< width * height * depth * channels, 255 is 1; empty: see floats
    std::vector<float> floats;
};

/// What the opacity of a point of a volume means.
enum class VolumeLaw : uint8_t
{
    Density, ///< the factor of the coefficients of Volume::medium
    Cells,   ///< the share of light that is lost over a cell of the image
    Samples, ///< the share of light that is lost over Volume::sampleLength
};

/// Holds a volume: the part of an image's box that is within another box.
struct Volume
{
    std::shared_ptr<const VolumeImage> image; ///< never null
    /// RGBA by value, evenly from 0 to 1, linear between entries and to a border of 0 beyond the
    /// outermost ones; empty: colours are the voxels'
    /// own, and those of images of one channel are the value.
    std::vector<Vec4> transfer;
    float transferScale = 1.0f, transferOffset = 0.0f; ///< from the image's values to 0 to 1

    Affine imageFromEngine; ///< the image fills the unit cube
    Affine tileFromEngine;  ///< nothing is beyond the unit cube of this space

    VolumeLaw law = VolumeLaw::Cells;
    Medium medium;             ///< with VolumeLaw::Density, at an opacity of 1
    float transparency = 1.0f; ///< factor of opacities
    float cutoff = 0.0f;       ///< where the image has a value (Samples: opacity) below, nothing is
    float sampleRatio = 1.0f;  ///< steps a cell of Whitted's integrator, with Cells
    float sampleLength = 5e-4f; ///< [widths of the image], with Samples
    bool lit = false;           ///< colours are what is lit by lights, by the gradient of values
    Vec3 tint{1.0f};            ///< factor of colours, with Samples

    Stamp changed = 0;
};

/// Returns whether two volumes are the same but for their stamps. Images are compared by address.
bool sameVolume(const Volume& a, const Volume& b);

} // namespace osgRayTrace::engine
