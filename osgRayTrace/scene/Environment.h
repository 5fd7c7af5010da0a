// Environment.h - light from all around, as an image of the sphere. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds radiance by latitude and longitude; each pixel is a patch of constant radiance. Column x +
/// 1/2 of width is azimuth (x + 1/2) / width of a turn from -y clockwise as seen from above. So the
/// image's middle is +y, and +x is to the right of the middle. Rows divide the angle from nadir
/// (-z) to zenith (+z) evenly.
struct EnvironmentImage
{
    int width = 0;
    int height = 0;
    std::vector<Vec3>
        radiance; ///< width*height, row 0 at the nadir; finite, not negative, at most 1e30
};

/// Holds what an environment light has beside its radiance, which multiplies the image.
struct Environment
{
    std::shared_ptr<const EnvironmentImage> image;
    Mat3 mapFromEngine{1.0f}; ///< orthogonal; may mirror
    bool visible = true;      ///< camera rays see the environment; mirrors and glass always show it
};

} // namespace osgRayTrace::engine
