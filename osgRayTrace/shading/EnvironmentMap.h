// EnvironmentMap.h - an image of the sphere as a distribution over directions. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Environment.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// A direction towards an environment.
struct EnvironmentSample
{
    Vec3 direction{0.0f, 0.0f, 1.0f}; ///< unit
    Vec3 radiance{0.0f};
    float pdfW = 0.0f; ///< [1/sr]; 0: nothing to sample
};

/// In the space of the image. Directions are distributed as luminance: that of a pixel over the
/// integral of it over the sphere, uniform within a pixel, as the radiance is. So radiance over
/// density has one luminance everywhere, and each pixel that is not black is reached, however small
/// its share [Pharr16, sect. 14.2.4]. Built once for an image; thread safe.
class EnvironmentMap
{
public:
    explicit EnvironmentMap(std::shared_ptr<const EnvironmentImage> image);

    const std::shared_ptr<const EnvironmentImage>& image() const { return _image; }

    /// Integral of radiance over the sphere, and of its luminance.
    const Vec3d& integral() const { return _integral; }
    double luminanceIntegral() const { return _luminanceIntegral; }
    bool isBlack() const { return !(_luminanceIntegral > 0.0); }

    /// u, v in [0,1): neighbouring numbers give neighbouring directions.
    EnvironmentSample sample(float u, float v) const;

    /// Of sample; direction is unit.
    float pdfW(Vec3 direction) const;

    /// Of the pixel: what lights surfaces.
    Vec3 radiance(Vec3 direction) const { return _image->radiance[pixelOf(direction)]; }

    /// Between the middles of pixels: what is looked at. Light is not computed with it, because its
    /// density would be another one.
    Vec3 interpolatedRadiance(Vec3 direction) const;

    /// [sr] of a pixel in a row.
    double solidAngle(int row) const;

    /// Towards a point of the image; x in [0, width], y in [0, height].
    Vec3d direction(double x, double y) const;

private:
    std::size_t pixelOf(Vec3 direction) const;
    Vec3 pixelAt(int x, int y) const;

    std::shared_ptr<const EnvironmentImage> _image;
    Vec3d _integral{0.0};
    double _luminanceIntegral = 0.0;
    int _blocksPerRow = 0;
    std::vector<double> _rowZ;   ///< z of the lower border of each row, and 1
    std::vector<double> _rows;   ///< running sum of luminance times solid angle, a row
    std::vector<double> _blocks; ///< running sum of luminance within a row, a block of pixels
};

} // namespace osgRayTrace::engine
