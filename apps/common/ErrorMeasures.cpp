// ErrorMeasures.cpp - compares with a reference. Layer: apps.
// SPDX-License-Identifier: MIT
#include "ErrorMeasures.h"

#include <cmath>

namespace osgRayTrace::app
{

ErrorMeasures ErrorSum::measures() const
{
    const double count = static_cast<double>(_count);
    return {std::sqrt(_squares / count), _relativeSquares / count, _pictureSum / _referenceSum};
}

ErrorMeasures errorMeasures(const osg::Image& picture, const osg::Image& reference)
{
    const int pictureStep = picture.getPixelFormat() == GL_RGBA ? 4 : 3;
    const int referenceStep = reference.getPixelFormat() == GL_RGBA ? 4 : 3;
    ErrorSum sum;
    for (int y = 0; y < picture.t(); ++y)
    {
        const float* x = reinterpret_cast<const float*>(picture.data(0, y));
        const float* r = reinterpret_cast<const float*>(reference.data(0, y));
        for (int column = 0; column < picture.s(); ++column, x += pictureStep, r += referenceStep)
        {
            for (int c = 0; c < 3; ++c)
                sum.add(x[c], r[c]);
        }
    }
    return sum.measures();
}

} // namespace osgRayTrace::app
