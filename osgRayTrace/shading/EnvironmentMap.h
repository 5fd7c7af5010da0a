// EnvironmentMap.h - an image of the sphere as a distribution over directions. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Environment.h"

#include <cstddef>
#include <cstdint>
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

/// Names a distribution over directions.
enum class EnvironmentDensity : uint8_t
{
    /// As luminance: radiance over density has one luminance everywhere, and each pixel that is not
    /// black is reached, however small its share is [Pharr16, sect. 14.2.4].
    Luminance,
    /// As max(0, luminance - mean over the sphere) [Karlik19]: directions that are no brighter than
    /// the mean are left to another technique that reaches all of them, by multiple importance
    /// sampling. A sky of even radiance has nothing to sample.
    Compensated,
};

/// Samples directions in the space of the image by either density, which is uniform within a pixel
/// as the radiance is. The map is built once for an image; thread safe.
class EnvironmentMap
{
public:
    explicit EnvironmentMap(std::shared_ptr<const EnvironmentImage> image);

    const std::shared_ptr<const EnvironmentImage>& image() const { return _image; }

    /// Returns the integral over the sphere, of radiance and of luminance.
    const Vec3d& integral() const { return _integral; }
    double luminanceIntegral() const { return _luminance.integral; }
    bool isBlack() const { return !(_luminance.integral > 0.0); }

    /// Returns whether sample finds nothing by EnvironmentDensity::Compensated.
    bool isEven() const { return !(_compensated.integral > 0.0); }

    /// Returns a sample. u, v in [0,1): neighbouring numbers give neighbouring directions.
    EnvironmentSample sample(float u, float v,
                             EnvironmentDensity density = EnvironmentDensity::Luminance) const;

    /// Returns the density [1/sr] with which sample chooses a direction, which is unit.
    float pdfW(Vec3 direction, EnvironmentDensity density = EnvironmentDensity::Luminance) const;

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
    /// Holds running sums of the pixels' weights.
    struct Sums
    {
        double floor = 0.0;         ///< luminance that counts as none
        double integral = 0.0;      ///< weight times solid angle; 0: nothing to sample
        std::vector<double> rows;   ///< a row: running sum of weight times solid angle
        std::vector<double> blocks; ///< a block of pixels: running sum of weight within the row
    };
    Sums sumsOver(double floor) const;
    const Sums& sums(EnvironmentDensity density) const
    {
        return density == EnvironmentDensity::Compensated ? _compensated : _luminance;
    }

    const Vec3* row(int y) const
    {
        return &_image->radiance[static_cast<std::size_t>(y) *
                                 static_cast<std::size_t>(_image->width)];
    }
    std::size_t pixelOf(Vec3 direction) const;
    Vec3 pixelAt(int x, int y) const;

    std::shared_ptr<const EnvironmentImage> _image;
    Vec3d _integral{0.0};
    int _blocksPerRow = 0;
    std::vector<double> _rowZ; ///< z of the lower border of each row, and 1
    Sums _luminance, _compensated;
};

} // namespace osgRayTrace::engine
