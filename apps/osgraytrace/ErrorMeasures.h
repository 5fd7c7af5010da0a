// ErrorMeasures.h - how far a picture is from a reference. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>

namespace osgRayTrace::app
{

/// Over the linear RGB values x of a picture and r of its reference.
struct ErrorMeasures
{
    double rmse = 0.0;      ///< root of mean((x - r)^2)
    double relMse = 0.0;    ///< mean((x - r)^2 / (r^2 + 0.01))
    double meanRatio = 0.0; ///< mean(x) / mean(r)
};

/// Both of the same size, GL_RGB or GL_RGBA, GL_FLOAT.
ErrorMeasures errorMeasures(const osg::Image& picture, const osg::Image& reference);

} // namespace osgRayTrace::app
