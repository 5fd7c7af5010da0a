// ErrorMeasures.cpp - compares with a reference. Layer: apps.
// SPDX-License-Identifier: MIT
#include "ErrorMeasures.h"

#include <cmath>

namespace osgRayTrace::app
{

namespace
{

constexpr double kRelMseOffset = 0.01; ///< keeps dark pixels from deciding

} // namespace

ErrorMeasures errorMeasures(const osg::Image& picture, const osg::Image& reference)
{
    const int pictureStep = picture.getPixelFormat() == GL_RGBA ? 4 : 3;
    const int referenceStep = reference.getPixelFormat() == GL_RGBA ? 4 : 3;
    double squares = 0.0;
    double relativeSquares = 0.0;
    double pictureSum = 0.0;
    double referenceSum = 0.0;
    for (int y = 0; y < picture.t(); ++y)
    {
        const float* x = reinterpret_cast<const float*>(picture.data(0, y));
        const float* r = reinterpret_cast<const float*>(reference.data(0, y));
        for (int column = 0; column < picture.s(); ++column, x += pictureStep, r += referenceStep)
        {
            for (int c = 0; c < 3; ++c)
            {
                const double difference = double(x[c]) - r[c];
                squares += difference * difference;
                relativeSquares += difference * difference / (double(r[c]) * r[c] + kRelMseOffset);
                pictureSum += x[c];
                referenceSum += r[c];
            }
        }
    }

    const double count = 3.0 * picture.s() * picture.t();
    return {std::sqrt(squares / count), relativeSquares / count, pictureSum / referenceSum};
}

} // namespace osgRayTrace::app
