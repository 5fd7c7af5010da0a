// ErrorMeasures.h - how far a picture is from a reference. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>

#include <cstdint>

namespace osgRayTrace::app
{

/// Holds measures over the linear RGB values x of a picture and r of its reference.
struct ErrorMeasures
{
    double rmse = 0.0;      ///< root of mean((x - r)^2)
    double relMse = 0.0;    ///< mean((x - r)^2 / (r^2 + offset))
    double meanRatio = 0.0; ///< mean(x) / mean(r)
};

constexpr double kRelMseOffset = 0.01; ///< keeps dark pixels from dominating

/// Computes the measures of values that are added one by one.
class ErrorSum
{
public:
    explicit ErrorSum(double offset = kRelMseOffset) : _offset(offset) {}

    void add(double x, double r)
    {
        const double square = (x - r) * (x - r);
        _squares += square;
        _relativeSquares += square / (r * r + _offset);
        _pictureSum += x;
        _referenceSum += r;
        ++_count;
    }

    ErrorMeasures measures() const;

private:
    double _offset;
    double _squares = 0.0;
    double _relativeSquares = 0.0;
    double _pictureSum = 0.0;
    double _referenceSum = 0.0;
    int64_t _count = 0;
};

/// Returns the measures of two images of one size, GL_RGB or GL_RGBA, GL_FLOAT.
ErrorMeasures errorMeasures(const osg::Image& picture, const osg::Image& reference);

} // namespace osgRayTrace::app
