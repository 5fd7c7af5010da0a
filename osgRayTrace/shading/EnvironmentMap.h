// EnvironmentMap.h - an image of the sphere as a distribution over directions. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Environment.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds a direction towards an environment.
struct EnvironmentSample
{
    Vec3 direction{0.0f, 0.0f, 1.0f}; ///< unit
    Vec3 radiance{0.0f};
    float pdfW = 0.0f; ///< [1/sr]; 0: nothing to sample
};

/// Samples directions in the space of the image. Directions are distributed as luminance: that of a
/// pixel over the integral over the sphere, uniform within a pixel, as the radiance is. So radiance
/// over density has one luminance everywhere, and each pixel that is not black is reached, however
/// small its share is [Pharr16, sect. 14.2.4]. The map is built once for an image; thread safe.
class EnvironmentMap
{
public:
    explicit EnvironmentMap(std::shared_ptr<const EnvironmentImage> image);

    const std::shared_ptr<const EnvironmentImage>& image() const { return _image; }

    /// Returns the integral over the sphere, of radiance and of luminance.
    const Vec3d& integral() const { return _integral; }
    double luminanceIntegral() const { return _luminanceIntegral; }
    bool isBlack() const { return !(_luminanceIntegral > 0.0); }

    /// Returns a sample. u, v in [0,1): neighbouring numbers give neighbouring directions.
    EnvironmentSample sample(float u, float v) const;

    /// Returns the density [1/sr] with which sample chooses a direction, which is unit.
    float pdfW(Vec3 direction) const;

    /// Returns the radiance of the pixel, which is the one that lights surfaces.
    Vec3 radiance(Vec3 direction) const { return _image->radiance[pixelOf(direction)]; }

    /// Returns the radiance interpolated between the middles of pixels: for directions that are
    /// looked at, not for light, because sample has another density.
    Vec3 interpolatedRadiance(Vec3 direction) const;

    /// Returns the solid angle [sr] of a pixel in a row.
    double solidAngle(int row) const;

    /// Returns the direction towards a point of the image; x in [0, width], y in [0, height].
    Vec3d direction(double x, double y) const;

private:
    std::size_t pixelOf(Vec3 direction) const;
    Vec3 pixelAt(int x, int y) const;

    std::shared_ptr<const EnvironmentImage> _image;
    Vec3d _integral{0.0};
    double _luminanceIntegral = 0.0;
    int _blocksPerRow = 0;
    std::vector<double> _rowZ;   ///< z of the lower border of each row, and 1
    std::vector<double> _rows;   ///< a row: running sum of luminance times solid angle
    std::vector<double> _blocks; ///< a block of pixels: running sum of luminance within the row
};

} // namespace osgRayTrace::engine
